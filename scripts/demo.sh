#!/usr/bin/env bash
# Builds palpate and touches a cloud with it: scripts/demo.sh [CLOUD]
#
# Without CLOUD the cloud is one that palpate makes itself, so nothing is fetched but packages.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
case "${1:-}" in -h | --help)
  sed -n '2,4s/^# \{0,1\}//p' "$0"
  exit
  ;;
esac
cloud=${1:-synthetic:bumps}
if [ -e "$called_from/$cloud" ]; then cloud=$(realpath "$called_from/$cloud"); fi
started=$SECONDS

say "packages"
need_packages build picture

say "build"
# A tree that holds the tests keeps them, unless packages that they need are absent.
if ! { [ -f build/release/CMakeCache.txt ] && cmake --preset release >/dev/null 2>&1; }; then
  configure release -DPALPATE_BUILD_TESTS=OFF
fi
build release palpate_app

say "touch $cloud"
mkdir -p build/demo
build/release/apps/palpate/palpate touch "$cloud" \
  --picture build/demo/touch.png --log build/demo/touch.csv --json build/demo/touch.json

say "done in $((SECONDS - started)) s"
note "picture: $PWD/build/demo/touch.png"
note "log:     $PWD/build/demo/touch.csv (a servo step a row)"
note "next:    build/release/apps/palpate/palpate touch YOUR_CLOUD --picture touch.png"
