# shellcheck shell=bash disable=SC2034
# Shared by the scripts in this folder; sourced, not run.

set -euo pipefail
called_from=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

say() { printf '\n== %s\n' "$*"; }
note() { printf '   %s\n' "$*"; }
fail() {
  printf 'error: %s\n' "$*" >&2
  exit 1
}

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null; then
    sudo "$@"
  else
    fail "'$*' needs root, but there is no sudo: run it as root, then restart this script"
  fi
}

is_installed() {
  [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# The alternatives of a group's packages, one "a|b" a line.
packages_of() {
  awk -v group="$1" '$1 == group { print $2 }' scripts/packages.txt
}

# Those of a group for which no alternative is installed.
missing_of() {
  local alternatives name
  for alternatives in $(packages_of "$1"); do
    for name in ${alternatives//|/ }; do
      if is_installed "$name"; then continue 2; fi
    done
    echo "$alternatives"
  done
}

# The first alternative that apt can install.
choose() {
  local name
  for name in ${1//|/ }; do
    if apt-cache show --no-all-versions "$name" >/dev/null 2>&1; then
      echo "$name"
      return
    fi
  done
  fail "no apt package found for: $1"
}

# need_packages GROUP...: installs what is absent of these groups and nothing else.
need_packages() {
  local group alternatives missing=() chosen=()
  if ! command -v apt-get >/dev/null; then
    note "no apt: install these packages or their equivalents yourself: $*"
    return
  fi
  for group in "$@"; do
    for alternatives in $(missing_of "$group"); do missing+=("$alternatives"); done
  done
  if [ ${#missing[@]} -eq 0 ]; then
    note "packages ($*): all installed"
    return
  fi
  as_root apt-get update -qq
  for alternatives in "${missing[@]}"; do chosen+=("$(choose "$alternatives")"); done
  note "packages ($*): installing ${chosen[*]}"
  as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${chosen[@]}" >/dev/null
}

# What builds the page; an npm that is there already, of whatever origin, will do.
need_npm() {
  if command -v npm >/dev/null; then
    note "npm: found ($(npm --version))"
  else
    need_packages page
  fi
}

# need_modules FOLDER: what its lock names, asked for again only when that is newer. Tests that use it are skipped
# without.
need_modules() {
  local installed=$1/node_modules/.package-lock.json # npm writes it when it is done
  if [ -e "$installed" ] && [ ! "$1/package-lock.json" -nt "$installed" ]; then return; fi
  if command -v npm >/dev/null && (cd "$1" && npm ci --no-audit --no-fund --ignore-scripts) >build/npm.log 2>&1; then
    note "$1: npm has installed what its lock names"
  else
    note "$1: npm could not install what its lock names (build/npm.log); tests that need it are skipped"
  fi
}

# The browser of the page's tests, where the distribution has one that is no snap.
need_browser() {
  if grep -q '^ID=debian$' /etc/os-release; then
    need_packages browser
  else
    note "this distribution has no chromium package: browser tests are skipped"
  fi
}

# One compiler a core, but no more than memory holds (about 1.5 GB each).
jobs_that_fit() {
  local cores memory
  cores=$(nproc)
  memory=$(awk '/MemAvailable/ { print int($2 / 1500000) }' /proc/meminfo)
  if [ "$memory" -lt 1 ]; then memory=1; fi
  echo $((memory < cores ? memory : cores))
}

# configure PRESET [CMAKE OPTION...]
configure() {
  local preset=$1 linker
  shift
  # What ccache has seen it need not compile, and it knows little of precompiled headers.
  if command -v ccache >/dev/null; then
    set -- -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON "$@"
  fi
  for linker in mold lld; do
    if command -v "ld.$linker" >/dev/null; then
      set -- -DCMAKE_EXE_LINKER_FLAGS="-fuse-ld=$linker" "$@"
      break
    fi
  done
  # Sources compiled eight at a time take a third of the time.
  cmake --preset "$preset" -DCMAKE_UNITY_BUILD=ON "$@" >"build/$preset.configure.log" 2>&1 ||
    { cat "build/$preset.configure.log" >&2; fail "cmake could not configure preset $preset"; }
}

# keep_time STEP SECONDS PARTS: how long a step took, and of how many parts it was.
keep_time() { printf '%s\t%s\t%s\n' "$1" "$2" "$3" >>build/steps.tsv; }

# time_left STEP PARTS: words on how long so many parts of a step will take, by the last time that it was done.
time_left() {
  awk -F '\t' -v step="$1" -v parts="$2" '
    $1 == step { seconds = $2 / $3 * parts; known = 1 }
    END { if (known) printf ", about %d s left", seconds }' build/steps.tsv 2>/dev/null || true
}

# progress WORDS: on a terminal one line that changes, else a line each half minute.
progress_told=$SECONDS
progress() {
  if [ -t 1 ]; then
    printf '\r   %s\033[K' "$1"
  elif [ $((SECONDS - progress_told)) -ge 30 ]; then
    note "$1"
    progress_told=$SECONDS
  fi
}
end_progress() { if [ -t 1 ]; then printf '\r\033[K'; fi; }

# show_steps PRESET: of ninja's output, how far it is.
show_steps() {
  local line
  while IFS= read -r line; do
    if [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]]; then
      progress "preset $1: built ${BASH_REMATCH[1]}/${BASH_REMATCH[2]}$(
        time_left "$1: build" $((BASH_REMATCH[2] - BASH_REMATCH[1])))"
    fi
  done
  end_progress
}

# build PRESET [TARGET...]
build() {
  local preset=$1 started=$SECONDS
  shift
  local target=()
  if [ $# -gt 0 ]; then target=(--target "$@"); fi
  cmake --build "build/$preset" -j "$(jobs_that_fit)" "${target[@]}" 2>&1 |
    tee "build/$preset.build.log" | show_steps "$preset" ||
    { tail -n 60 "build/$preset.build.log" >&2; fail "preset $preset does not build; full log: build/$preset.build.log"; }
  if grep -q 'no work to do' "build/$preset.build.log"; then
    note "preset $preset: up to date, nothing to build"
  else
    keep_time "$preset: build" $((SECONDS - started)) "$(grep -cE '^\[[0-9]+/' "build/$preset.build.log")"
    note "preset $preset: built in $((SECONDS - started)) s"
  fi
}

# Real data for tests, where it is there.
find_data() {
  if [ -z "${PALPATE_DATA:-}" ] && [ -d ../shared/data ]; then
    PALPATE_DATA=$(cd ../shared/data && pwd)
    export PALPATE_DATA
  fi
  note "real data: ${PALPATE_DATA:-none (PALPATE_DATA is not set; those tests are skipped)}"
}

# show_tests PRESET STEP: of ctest's output, how far it is and what has failed.
show_tests() {
  local line failed=0
  while IFS= read -r line; do
    if [[ ! $line =~ ^\ *([0-9]+)/([0-9]+)\ Test\ +#[0-9]+:\ ([^ ]+) ]]; then continue; fi
    local done=${BASH_REMATCH[1]} all=${BASH_REMATCH[2]} name=${BASH_REMATCH[3]}
    if [[ $line == *"***"* && $line != *"***Skipped"* ]]; then
      failed=$((failed + 1))
      end_progress
      note "preset $1: $name failed"
    fi
    progress "preset $1: tested $done/$all, $failed failed$(time_left "$2" $((all - done)))"
  done
  end_progress
}

# test_preset PRESET [CTEST OPTION...]: runs ctest, keeps its log, fails as it fails; says what was slow, and how to run
# alone what failed.
test_preset() {
  local preset=$1 started=$SECONDS status=0 step
  shift
  step="$preset: tests $*"
  rm -f "build/$preset"/times/*.tsv
  ctest --test-dir "build/$preset" --output-on-failure -j "$(jobs_that_fit)" "$@" 2>&1 |
    tee "build/$preset.test.log" | show_tests "$preset" "$step" || status=$?
  if [ $status -eq 0 ]; then
    keep_time "$step" $((SECONDS - started)) "$(grep -cE '^ *[0-9]+/[0-9]+ Test' "build/$preset.test.log")"
  else
    grep -vE '^ *[0-9]+/[0-9]+ Test .*Passed|^ +Start ' "build/$preset.test.log" || true
    note "preset $preset: to run alone what failed:"
    scripts/times.py --failed "build/$preset" | sed 's/^/     /'
  fi
  note "preset $preset: the slowest cases:"
  scripts/times.py --slowest 5 "build/$preset" | sed 's/^/     /'
  note "preset $preset: $(grep -E 'tests passed|No tests' "build/$preset.test.log" || echo 'ctest did not finish') ($((SECONDS - started)) s)"
  return $status
}

# The reasons that skipped tests of a preset gave, and how many gave each.
skipped() {
  awk '/: Skipped$/ { getline; print }' "build/$1/Testing/Temporary/LastTest.log" | sort | uniq -c |
    sed "s/^/   $1: /"
}

# ctest's own last word on a preset.
summary() {
  note "$1: $(grep -E 'tests passed' "build/$1.test.log" || echo 'ctest did not finish')"
}

# Sets `sanitized`, the preset of sanitized builds. With clang one build holds tests and fuzz targets; a script that sets
# `fuzz` to no does without.
need_sanitizers() {
  fuzz=${fuzz:-yes}
  if [ "$fuzz" = yes ]; then need_packages fuzz; fi
  if [ "$fuzz" = yes ] && ! command -v clang++ >/dev/null; then
    note "clang++ not found: no fuzz targets"
    fuzz=no
  fi
  if [ "$fuzz" = yes ]; then sanitized=fuzz; else sanitized=asan; fi
}

# test_names PRESET NAME...: runs the cases of all test programs, and the other entries of ctest, whose names hold one of
# these. Fails where one fails, or where there is none.
test_names() {
  local preset=$1 name program listed filter="" ran=0 status=0
  shift
  for name in "$@"; do filter+="*$name*:"; done
  while read -r program; do
    listed=$("$program" --gtest_list_tests --gtest_filter="$filter" | grep -c '^  ' || true)
    if [ "$listed" -eq 0 ]; then continue; fi
    ran=$((ran + listed))
    note "$program --gtest_filter='$filter'"
    "$program" --gtest_brief=1 --gtest_filter="$filter" || status=1
  done < <(find "build/$preset/tests" -name '*_test' -type f -executable | sort)
  listed=$(IFS='|'; echo "$*")
  if ctest --test-dir "build/$preset" -N -R "$listed" | grep -q 'Test *#'; then
    ran=$((ran + 1))
    ctest --test-dir "build/$preset" --output-on-failure -R "$listed" || status=1
  fi
  if [ "$ran" -eq 0 ]; then fail "no test has a name that holds: $*"; fi
  return $status
}

# fuzz_one NAME SECONDS: a fuzz target over its seeds in fuzz/corpus/NAME. Inputs that are found stay
# out of the tree; one that breaks something is kept as build/fuzz/found/NAME-*.
fuzz_one() {
  local name=$1 seconds=$2 seeds=()
  mkdir -p build/fuzz/found "build/fuzz/corpus/$name"
  if [ -d "fuzz/corpus/$name" ]; then seeds=("fuzz/corpus/$name"); fi
  if "build/fuzz/fuzz/fuzz_$name" "build/fuzz/corpus/$name" "${seeds[@]}" \
    -max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 \
    -artifact_prefix="build/fuzz/found/$name-" >"build/fuzz/$name.log" 2>&1; then
    note "$name: $(grep -oE 'Done [0-9]+ runs' "build/fuzz/$name.log" || true), clean"
  else
    tail -n 30 "build/fuzz/$name.log" >&2
    note "$name: FAILED; full log: build/fuzz/$name.log"
    return 1
  fi
}

# fuzz_all SECONDS: every target, a few at a time; all of them even if one breaks.
fuzz_all() {
  local target status=0 running=0
  for target in build/fuzz/fuzz/fuzz_*; do
    if [ ! -f "$target" ] || [ ! -x "$target" ]; then continue; fi
    fuzz_one "${target##*/fuzz_}" "$1" &
    running=$((running + 1))
    if [ "$running" -ge "$(jobs_that_fit)" ]; then
      wait -n || status=1
      running=$((running - 1))
    fi
  done
  while [ "$running" -gt 0 ]; do
    wait -n || status=1
    running=$((running - 1))
  done
  return $status
}

mkdir -p build
