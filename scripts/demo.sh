#!/usr/bin/env bash
# Builds palpate and shows it: scripts/demo.sh [SCENE] [OPTION...]
#
# A page opens in the browser (its address is printed, too): what a depth camera sees, simulated so
# that nothing is needed, with a tool in it that explores by itself until you take it. Scenes: desk
# (the default), scan, two, room. Options are those of `palpate demo`, such as --duration 10
# --headless. Ctrl-C ends it, and tells how it went; without a terminal it ends after 10 s.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
case "${1:-}" in -h | --help)
  sed -n '2,7s/^# \{0,1\}//p' "$0"
  exit
  ;;
esac
started=$SECONDS

say "packages"
need_packages build viewer
need_npm

say "build"
# A tree that holds the tests keeps them, unless packages that they need are absent.
if ! { [ -f build/release/CMakeCache.txt ] && cmake --preset release >/dev/null 2>&1; }; then
  configure release -DPALPATE_BUILD_TESTS=OFF
fi
build release palpate_app

say "demo (ready after $((SECONDS - started)) s)"
note "to touch your own cloud: build/release/apps/palpate/palpate touch YOUR_CLOUD --view"
# Where nobody could end it, it ends by itself.
if [ ! -t 0 ] && [[ " $* " != *" --duration"* ]]; then set -- "$@" --duration 10; fi
exec build/release/apps/palpate/palpate demo "$@"
