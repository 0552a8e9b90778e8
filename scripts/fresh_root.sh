#!/usr/bin/env bash
# Tries what the README promises where nothing is installed: makes a Debian 12 root in
# build/fresh_root, clones this repository into it, and runs scripts/demo.sh there.
#
# scripts/fresh_root.sh [--test] [MIRROR]
#   --test   runs the demo a second time and scripts/test.sh, too
#   MIRROR   default: the one that this machine's apt uses
# What is committed is what is tried. Each run begins with a root that holds nothing but apt, of which
# ~/.cache/palpate keeps a copy for a month. The root stays for a look until the next run removes it;
# nothing stays mounted. Where none can be made, the reason is told and the status is 77.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/lib.sh"
# shellcheck source=scripts/bare_root.sh
source scripts/bare_root.sh
with_test=no
case "${1:-}" in
  --test)
    with_test=yes
    shift
    ;;
  -*)
    sed -n '2,10s/^# \{0,1\}//p' "$0"
    exit 2
    ;;
esac
started=$SECONDS
say "fresh root"
can_make_roots "$@"
make_root fresh_root
git diff --quiet HEAD || note "uncommitted changes are not tested"
git clone --quiet --no-hardlinks "$PWD" "$root/root/palpate"
note "created in $((SECONDS - started)) s"

timed "scripts/demo.sh --headless --duration 5"
[ -f "$root/root/palpate/build/release/src/viewer/page/app.js" ] || fail "in the fresh root: the page was not built"
if [ "$with_test" = yes ]; then
  timed "scripts/demo.sh --headless --duration 5"
  timed scripts/test.sh
fi
