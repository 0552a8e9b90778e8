#!/usr/bin/env bash
# Builds the core as WebAssembly, and compares its forces with those of a native build of portable bits, bit for bit.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
# shellcheck source=scripts/emscripten.sh
source scripts/emscripten.sh

if [ $# -gt 0 ]; then
  sed -n '2s/^# //p' "$0"
  exit
fi
need_packages build test
need_emscripten
find_data
configure portable
build portable forces
cmake --preset web -DPALPATE_NATIVE_FORCES="$PWD/build/portable/tests/forces/forces" >build/web.configure.log 2>&1 ||
  { cat build/web.configure.log >&2; fail "cmake could not configure preset web"; }
build web
test_preset web
