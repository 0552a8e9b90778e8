#!/usr/bin/env bash
# What takes longer than scripts/test.sh: Debug, TSan and ASan + UBSan builds with every test, the long
# tests and the benches' tables in a release build, the documents' site, a minute of fuzzing a target and,
# where they can be made, the trials in fresh Debian roots of both README commands and of Debian packages.
#
# --no-fresh-root leaves these two out. --soak does another thing instead: ten minutes of touching two
# cameras in real time while other load rises and falls; no memory may leak and no step be a fault.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
fresh=yes
case "${1:-}" in
  --no-fresh-root) fresh=no ;;
  "" | --soak) ;;
  *)
    sed -n '2,7s/^# \{0,1\}//p' "$0"
    exit
    ;;
esac
started=$SECONDS
status=0

if [ "${1:-}" = --soak ]; then
  need_packages build
  configure release
  build release palpate_app
  say "soak, 10 minutes"
  exec scripts/soak.py build/release/apps/palpate/palpate 600
fi

say "packages"
need_packages build cameras viewer ros python test peers fuzz lint bench
need_npm
need_modules tests/peer
need_browser
find_data

say "Debug, benches among them"
configure dev -DPALPATE_BUILD_BENCH=ON
build dev
test_preset dev || status=1

say "thread sanitizer"
# On one processor, so that TBB takes no workers: as packaged it is not instrumented, and what it hands
# over would look like races of ours. Threads that the tests start take turns there all the same.
configure tsan
build tsan
(taskset -cp 0 "$BASHPID" >/dev/null && test_preset tsan) || status=1

say "address and undefined-behaviour sanitizers, arithmetic and long tests among them"
configure fuzz -DPALPATE_TEST_ARITHMETIC=ON
build fuzz
test_preset fuzz || status=1
say "the Python module under address and undefined-behaviour sanitizers"
configure asan
build asan palpate_python palpate_app fake_dhd
test_preset asan -R '^python/' || status=1

say "long tests in a release build"
configure release -DPALPATE_BUILD_TESTS=ON -DPALPATE_BUILD_BENCH=ON
build release
test_preset release -L long || status=1

say "in the tree of another project, as shared libraries"
if cmake -S tests/project/embedded -B build/embedded -G Ninja -DBUILD_SHARED_LIBS=ON -DCMAKE_UNITY_BUILD=ON \
  -DCMAKE_BUILD_TYPE=Release >build/embedded.log 2>&1 &&
  cmake --build build/embedded >>build/embedded.log 2>&1 && build/embedded/embedded >>build/embedded.log 2>&1; then
  note "embedded: builds and runs"
else
  tail -n 30 build/embedded.log >&2
  status=1
fi

say "the documents' site"
scripts/docs.sh || status=1

say "fuzz targets, 60 s each"
fuzz_all 60 || status=1

say "format and tidy, every file"
scripts/lint.sh --all || status=1

if [ "$fresh" = yes ]; then
  scripts/fresh_root.sh --test || [ $? -eq 77 ] || status=1  # 77: no such root can be made here
  scripts/package.sh || [ $? -eq 77 ] || status=1
else
  note "fresh root: skipped"
fi

say "summary (after $((SECONDS - started)) s)"
for preset in dev tsan fuzz asan release; do summary "$preset"; done
exit $status
