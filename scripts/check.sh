#!/usr/bin/env bash
# What only those who change palpate need: what takes longer than scripts/test.sh.
#
# scripts/check.sh           everything below but the soak: hours
# scripts/check.sh PART...   these parts, in this order:
#   seeds      under ASan + UBSan every fuzz target for 3 s over its seeds
#   sanitized  under ASan + UBSan every test but the long ones and those of what only computes
#   programs   in a release build what runs beside other programs: the page in a browser, whole, and ROS 2's topics
#              between processes; and long cases of a quarter of a minute
#   core       the core alone: builds, and passes its tests
#   bare       the program without any optional library
#   tab        the program of a tab: builds with its page, and passes its tests in Node
#   web        that, its page in a browser, in Node the tests of what it is made of, hostile files under sanitizers, and
#              forces bit for bit
#   debug      every test and the benches in a Debug build
#   threads    every test under TSan
#   long       every test under ASan + UBSan, the Python module among them; in a release build every test with all
#              rounds of property tests, and the benches' tables
#   embedded   palpate in the tree of another project, as shared libraries
#   documents  the documents' site
#   fuzz       every fuzz target for 60 s
#   lint       format and tidy of every file
#   fresh      both README commands and the Debian packages in fresh Debian roots, where such can be made
#   soak       ten minutes of touching two cameras in real time while other load rises and falls: no memory may leak and
#              no step be a fault
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
all=(sanitized programs core bare web debug threads long embedded documents fuzz lint fresh)
status=0

# bare_says WORDS ARGUMENT...: the program without optional libraries does this, and says these words.
bare_says() {
  local words=$1
  shift
  if build/bare/apps/palpate/palpate "$@" >build/bare.log 2>&1 && grep -q "$words" build/bare.log; then
    note "palpate $*: runs"
  else
    cat build/bare.log >&2
    note "palpate $*: FAILED, or its output lacks \"$words\""
    return 1
  fi
}

# SECONDS of each fuzz target; nothing where there is no clang.
fuzz_for() {
  need_sanitizers
  if [ "$fuzz" = no ]; then return; fi
  configure "$sanitized" -DPALPATE_TEST_ARITHMETIC=OFF
  build "$sanitized" all_fuzzers
  fuzz_all "$1"
}

check_seeds() { fuzz_for 3; }

check_sanitized() {
  local failed=0
  need_sanitizers
  configure "$sanitized" -DPALPATE_TEST_ARITHMETIC=OFF
  build "$sanitized"
  test_preset "$sanitized" -LE long || failed=1
  skipped "$sanitized"
  return $failed
}

check_programs() {
  configure release -DPALPATE_BUILD_TESTS=ON
  build release
  test_preset release -R '^(page|dds)/|^(align|depth|io|large|scene)/long'
}

check_core() {
  configure core
  build core
  test_preset core
}

check_bare() {
  local failed=0
  configure bare
  build bare palpate_app
  bare_says 'palpate [0-9]' --version || failed=1
  bare_says 'this build has no OpenNI2' cameras || failed=1
  bare_says 'this build has no libfreenect' cameras || failed=1
  bare_says 'this build has no Cyclone DDS' cameras || failed=1
  bare_says 'this build cannot connect to Haply' devices || failed=1
  bare_says 'contacts  *1' touch synthetic:sphere --duration 1 || failed=1
  bare_says 'frames  *30' touch camera:simulated --simulated-time --duration 1 || failed=1
  return $failed
}

# 77: there is no compiler for it here.
check_tab() { scripts/tab.sh --module || [ $? -eq 77 ]; }

check_web() { scripts/tab.sh || [ $? -eq 77 ]; }

check_debug() {
  need_packages bench
  configure dev -DPALPATE_BUILD_BENCH=ON
  build dev
  test_preset dev
}

# On one processor, so that TBB takes no workers: as packaged it is not instrumented, and what it hands over would look
# like races of ours. Threads that the tests start take turns there all the same.
check_threads() {
  configure tsan
  build tsan
  (taskset -cp 0 "$BASHPID" >/dev/null && test_preset tsan)
}

check_long() {
  local failed=0
  need_sanitizers
  configure "$sanitized" -DPALPATE_TEST_ARITHMETIC=ON
  build "$sanitized"
  test_preset "$sanitized" || failed=1
  configure asan
  build asan palpate_python palpate_app fake_dhd
  test_preset asan -R '^python/' || failed=1
  need_packages bench
  configure release -DPALPATE_BUILD_TESTS=ON -DPALPATE_BUILD_BENCH=ON
  build release
  test_preset release || failed=1
  return $failed
}

check_embedded() {
  if cmake -S tests/project/embedded -B build/embedded -G Ninja -DBUILD_SHARED_LIBS=ON -DCMAKE_UNITY_BUILD=ON \
    -DCMAKE_BUILD_TYPE=Release >build/embedded.log 2>&1 &&
    cmake --build build/embedded >>build/embedded.log 2>&1 && build/embedded/embedded >>build/embedded.log 2>&1; then
    note "embedded: builds and runs"
  else
    tail -n 30 build/embedded.log >&2
    return 1
  fi
}

check_documents() { scripts/docs.sh; }

check_fuzz() { fuzz_for 60; }

check_lint() { scripts/lint.sh --all; }

# 77: no such root can be made here.
check_fresh() {
  local failed=0
  scripts/fresh_root.sh --test || [ $? -eq 77 ] || failed=1
  scripts/package.sh || [ $? -eq 77 ] || failed=1
  return $failed
}

check_soak() {
  configure release
  build release palpate_app
  scripts/soak.py build/release/apps/palpate/palpate 600
}

parts=("$@")
if [ $# -eq 0 ]; then parts=("${all[@]}"); fi
for part in "${parts[@]}"; do
  if ! declare -F "check_$part" >/dev/null; then
    sed -n '2,25s/^# \{0,1\}//p' "$0"
    [[ "$part" == -h || "$part" == --help ]] || fail "no part is called '$part'"
    exit
  fi
done

say "packages"
need_packages build cameras viewer ros python test peers
need_npm
need_modules tests/peer
need_browser
find_data
took=()
for part in "${parts[@]}"; do
  say "$part"
  started=$SECONDS
  # A part ends at its first command that fails, and the next begins. (Behind && or if, -e would not count.)
  outcome=passed
  set +e
  (
    set -e
    "check_$part"
  )
  if [ $? -ne 0 ]; then outcome=FAILED status=1; fi
  set -e
  took+=("$(printf '%-10s %-6s %5d s' "$part" "$outcome" $((SECONDS - started)))")
done
say "summary"
for line in "${took[@]}"; do note "$line"; done
exit $status
