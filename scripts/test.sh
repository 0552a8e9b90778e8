#!/usr/bin/env bash
# Every test in a release build and under ASan + UBSan, and every fuzz target for 5 s over its seeds.
#
# With clang one sanitized build holds both (preset fuzz); --no-fuzz does without clang (preset asan)
# and without the fuzz targets. Real data is looked for in $PALPATE_DATA, else in
# ../shared/data; tests that need it are skipped, with the reason, where it is absent.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
fuzz=yes
for argument in "$@"; do
  case "$argument" in
    --no-fuzz) fuzz=no ;;
    *)
      sed -n '2,6s/^# \{0,1\}//p' "$0"
      exit
      ;;
  esac
done
started=$SECONDS
status=0

say "packages"
need_packages build cameras viewer test
need_npm
need_browser
if [ "$fuzz" = yes ]; then need_packages fuzz; fi
if [ "$fuzz" = yes ] && ! command -v clang++ >/dev/null; then
  note "clang++ is absent: no fuzz targets"
  fuzz=no
fi
if [ "$fuzz" = yes ]; then sanitized=fuzz; else sanitized=asan; fi
find_data

say "build"
configure release -DPALPATE_BUILD_TESTS=ON
build release
configure "$sanitized"
build "$sanitized"

if [ "$fuzz" = yes ]; then
  say "fuzz targets, 5 s each"
  fuzz_all 5 || status=1
fi

say "tests"
test_preset release || status=1
test_preset "$sanitized" || status=1

say "skipped, and why"
skipped release
skipped "$sanitized"

say "summary (after $((SECONDS - started)) s)"
for preset in release "$sanitized"; do summary "$preset"; done
exit $status
