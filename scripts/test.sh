#!/usr/bin/env bash
# Every test in a release build and under ASan + UBSan, and every fuzz target for 5 s over its seeds.
#
# --no-fuzz leaves the fuzz targets out. Real data is looked for in $PALPATE_DATA, else in
# ../shared/data; tests that need it are skipped, with the reason, where it is absent.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
fuzz=yes
for argument in "$@"; do
  case "$argument" in
    --no-fuzz) fuzz=no ;;
    *)
      sed -n '2,5s/^# \{0,1\}//p' "$0"
      exit
      ;;
  esac
done
started=$SECONDS
status=0

say "packages"
need_packages build test
if [ "$fuzz" = yes ]; then need_packages fuzz; fi
find_data

say "build"
configure release -DPALPATE_BUILD_TESTS=ON
build release
configure asan -DPALPATE_BUILD_TESTS=ON
build asan

if [ "$fuzz" = yes ]; then
  say "fuzz targets, 5 s each"
  configure fuzz
  build fuzz
  fuzz_all 5 || status=1
fi

say "tests"
test_preset release || status=1
test_preset asan || status=1

say "skipped, and why"
skipped release
skipped asan

say "summary (after $((SECONDS - started)) s)"
for preset in release asan; do summary "$preset"; done
exit $status
