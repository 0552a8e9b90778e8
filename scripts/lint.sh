#!/usr/bin/env bash
# clang-format and clang-tidy (both of version 14: each version formats in its own way).
#
# scripts/lint.sh          format of every file; tidy of what differs from the main branch
# scripts/lint.sh --all    both for every file
# scripts/lint.sh --fix    formats in place
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
mode=changed
case "${1:-}" in
  --all) mode=all ;;
  --fix) mode=fix ;;
  "") ;;
  *)
    sed -n '2,6s/^# \{0,1\}//p' "$0"
    exit
    ;;
esac

# Tracked files only, when git is there to tell.
sources() {
  if git rev-parse --git-dir >/dev/null 2>&1; then
    git ls-files '*.cpp' '*.hpp'
  else
    find apps bench examples fuzz include python src tests -name '*.cpp' -o -name '*.hpp'
  fi
}

# Sources that differ from where this branch left the main branch; on the main branch itself, from
# the last commit but one.
changed_sources() {
  local base
  base=$(git merge-base HEAD origin/main 2>/dev/null || true)
  if [ -z "$base" ] || [ "$base" = "$(git rev-parse HEAD)" ]; then
    base=$(git rev-parse --verify -q HEAD~1 || true)
  fi
  if [ -z "$base" ]; then sources; else git diff --name-only --diff-filter=d "$base" -- '*.cpp' '*.hpp'; fi
}

need_packages build cameras viewer ros python test peers lint
if [ "$mode" = fix ]; then
  sources | xargs clang-format-14 -i
  exit
fi

say "clang-format"
sources | xargs clang-format-14 --dry-run -Werror
note "$(sources | wc -l) files are formatted"

say "clang-tidy ($mode)"
cmake --preset dev -B build/tidy -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >build/tidy.configure.log 2>&1 ||
  { cat build/tidy.configure.log >&2; fail "cmake could not configure"; }
if [ "$mode" = all ]; then picked=$(sources); else picked=$(changed_sources); fi
# Headers are looked at through the sources that include them.
picked=$(grep '\.cpp$' <<<"$picked" | while read -r file; do
  if grep -q "\"file\": \"$PWD/$file\"" build/tidy/compile_commands.json; then echo "$file"; fi
done || true)
if [ -z "$picked" ]; then
  note "no compiled source changed"
  exit
fi
started=$SECONDS
# The flags are g++'s, some of which clang does not know.
xargs -P "$(jobs_that_fit)" -n 4 clang-tidy-14 -p build/tidy --quiet --extra-arg=-Wno-unknown-warning-option \
  --header-filter="^$PWD/(apps|bench|examples|fuzz|include|python|src|tests)/" <<<"$picked" \
  >build/tidy.log 2>build/tidy.err || { cat build/tidy.log; fail "clang-tidy reported problems"; }
note "$(wc -l <<<"$picked") sources are clean ($((SECONDS - started)) s)"
