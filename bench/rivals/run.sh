#!/usr/bin/env bash
# Plays every method on the drawn scenes and writes bench/RIVALS.md and docs/images/rivals.png.
#
# bench/rivals/run.sh   needs the packages of scripts/packages.txt (groups build, bench, picture)
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/../../scripts/lib.sh"
need_packages build bench picture

say "build"
configure release -DPALPATE_BUILD_BENCH=ON
build release compare_bench
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
program=build/release/bench/rivals/compare_bench
started=$SECONDS
say "drawn scenes"
"$program" --out "$scratch" >"$scratch/drawn.md"
drawn=$((SECONDS - started))
say "streams"
"$program" --streams --only "press,sphere slide,comes" >"$scratch/streams.md"
say "computing times"
"$program" --layouts 2 --seeds 1 --noise a --threads 1 --times | sed -n '/^| method | preparation/,$p' >"$scratch/times.md"
reading=$(sed -n '/^## What it says/,/^## Methods/p' bench/RIVALS.md | sed '$d') # people wrote it: see whether it still holds
say "picture"
/usr/bin/python3 bench/rivals/picture.py "$scratch" docs/images/rivals.png

{
  cat <<EOF
# Rivals

$(date +%Y-%m-%d), commit $(git rev-parse --short HEAD), $(nproc) cores ($(awk -F': ' '/model name/ { print $2; exit }' /proc/cpuinfo)). What
the methods are given, and what our readings of them are, says [README.md](README.md#rivals). All of it is made by

    bench/rivals/run.sh

whose first part, \`compare_bench\` (drawn layouts 501 to 508, two frames of each, noise a, b and c), took $((drawn / 60)) minutes. Tables
hold medians over the frames, with the worst in brackets; the first of a row is bold. They do not depend on the machine's
speed, but for the last one.

![](../docs/images/rivals.png)

$reading

## Methods

EOF
  cat "$scratch/drawn.md"
  cat <<EOF
## Streams

30 Hz, 640x480, in simulated time: a frame is felt 10 ms after its stamp.

EOF
  cat "$scratch/streams.md"
  cat <<EOF
## Computing times

On our index, in our programs, on a shared machine: what their authors' would take is not known. Two frames.

EOF
  cat "$scratch/times.md"
} >bench/RIVALS.md
say "bench/RIVALS.md is written"
