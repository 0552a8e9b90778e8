#!/usr/bin/env bash
# Builds the core and a tab's program as WebAssembly and the page of a tab in build/web/site, and tests them: forces are those
# of a native build of portable bits, bit for bit. --site: builds the page alone. --serve: that, on http://127.0.0.1:8430/.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
# shellcheck source=scripts/emscripten.sh
source scripts/emscripten.sh

# What any server of files can serve: no header of its own is wanted.
build_site() {
  local site=build/web/site
  build web tab
  need_modules web
  rm -rf "$site"
  mkdir -p "$site"
  (cd web && node build.mjs --tab "../$site")
  cp build/web/tab/tab.js build/web/tab/tab.wasm "$site"
  note "$site: $(du -sk "$site" | cut -f1) kB"
}

case "${1:-}" in
  "" | --site | --serve) ;;
  *)
    sed -n '2,3s/^# //p' "$0"
    exit
    ;;
esac
need_packages build test
need_emscripten
find_data
native=$PWD/build/portable/tests/forces/forces
if [ $# -eq 0 ]; then
  configure portable
  build portable forces
fi
cmake --preset web -DPALPATE_NATIVE_FORCES="$native" >build/web.configure.log 2>&1 ||
  { cat build/web.configure.log >&2; fail "cmake could not configure preset web"; }
build_site
if [ "${1:-}" = --serve ]; then exec python3 -m http.server 8430 --bind 127.0.0.1 --directory build/web/site; fi
if [ "${1:-}" = --site ]; then exit; fi
build web
test_preset web
PALPATE_SITE=$PWD/build/web/site tests/page/check.sh tab web "$PWD/build/web/pictures" build/web/site || [ $? -eq 77 ]
