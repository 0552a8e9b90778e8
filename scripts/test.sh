#!/usr/bin/env bash
# Tells within a quarter of an hour on two cores whether palpate works on this machine.
#
# scripts/test.sh            the release build with its tests, all but those that take more than 5 s each
# scripts/test.sh NAME...    builds, and runs only the cases and entries of ctest whose names hold one of these
#
# Property tests do a fifth of their rounds (PALPATE_TEST_EFFORT). All of them, the long tests and the sanitizers are in
# scripts/check.sh. Real data is looked for in $PALPATE_DATA, else in ../shared/data; tests that need it are skipped,
# with the reason, where it is absent.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
case "${1:-}" in -*)
  sed -n '2,10s/^# \{0,1\}//p' "$0"
  exit
  ;;
esac
started=$SECONDS
status=0
export PALPATE_TEST_EFFORT=${PALPATE_TEST_EFFORT:-0.2}

say "packages"
need_packages build cameras viewer ros python test peers
need_npm
need_modules tests/peer
need_browser
find_data

say "release build with tests"
configure release -DPALPATE_BUILD_TESTS=ON -DPALPATE_BUILD_BENCH=OFF
build release
if [ $# -gt 0 ]; then
  say "tests whose names hold: $*"
  test_names release "$@"
  exit
fi

say "tests"
test_preset release -LE long || status=1

say "skipped, and why"
skipped release

say "summary (after $((SECONDS - started)) s)"
summary release
exit $status
