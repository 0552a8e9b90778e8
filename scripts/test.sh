#!/usr/bin/env bash
# The tests in a release build and under ASan + UBSan, every fuzz target for 5 s over its seeds, and
# the program without any optional library. scripts/check.sh runs what takes longer: tests labelled
# "long", the benches' tables, and sanitizers over what only computes.
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
      sed -n '2,8s/^# \{0,1\}//p' "$0"
      exit
      ;;
  esac
done
started=$SECONDS
status=0

say "packages"
need_packages build cameras viewer ros python test peers
need_npm
need_modules tests/peer
need_browser
if [ "$fuzz" = yes ]; then need_packages fuzz; fi
if [ "$fuzz" = yes ] && ! command -v clang++ >/dev/null; then
  note "clang++ not found: no fuzz targets"
  fuzz=no
fi
if [ "$fuzz" = yes ]; then sanitized=fuzz; else sanitized=asan; fi
find_data

say "build"
configure release -DPALPATE_BUILD_TESTS=ON -DPALPATE_BUILD_BENCH=OFF
build release
configure "$sanitized" -DPALPATE_TEST_ARITHMETIC=OFF
build "$sanitized"
configure bare
build bare palpate_app

# bare WORDS ARGUMENT...: the program without optional libraries does this, and says these words.
bare() {
  local words=$1
  shift
  if build/bare/apps/palpate/palpate "$@" >build/bare.log 2>&1 && grep -q "$words" build/bare.log; then
    note "palpate $*: runs"
  else
    cat build/bare.log >&2
    note "palpate $*: FAILED, or its output lacks \"$words\""
    status=1
  fi
}
say "the program without optional libraries"
bare 'palpate [0-9]' --version
bare 'this build has no OpenNI2' cameras
bare 'this build has no libfreenect' cameras
bare 'this build has no Cyclone DDS' cameras
bare 'this build cannot connect to Haply' devices
bare 'contacts  *1' touch synthetic:sphere --duration 1
bare 'frames  *30' touch camera:simulated --simulated-time --duration 1

if [ "$fuzz" = yes ]; then
  say "fuzz targets, 5 s each"
  fuzz_all 5 || status=1
fi

say "tests"
test_preset release -LE long || status=1
test_preset "$sanitized" -LE long || status=1

say "skipped, and why"
skipped release
skipped "$sanitized"

say "summary (after $((SECONDS - started)) s)"
for preset in release "$sanitized"; do summary "$preset"; done
exit $status
