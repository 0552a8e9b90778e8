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
"$program" --streams --seeds 1 --only "press,sphere slide,comes" >"$scratch/streams.md"
say "events"
"$program" --events --seeds 1 --only "hidden by an arm,vanishes,plane to and fro at 0.1,from behind a plate" |
  sed 's/ ([^)]*)//g' >"$scratch/events.md" # the worst of one is the median
say "any cloud"
"$program" --any-cloud --seeds 3 >"$scratch/clouds.md" \
  --only "density 1:4,plate 1 jitter view,wedge 60 signs,corners noise 0.25 signs,rod 1R,closed sphere,partial box noise 0.3 view,stray single"
say "a recording"
recording=${PALPATE_DATA:-}/realsense_makerspace_mit
if [ -d "$recording" ]; then
  "$program" --recording "$recording" --first-frame 62 --frames 2 --ways 300 >"$scratch/recording.md"
else
  echo "Not played: PALPATE_DATA names no folder with realsense_makerspace_mit." >"$scratch/recording.md"
fi
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

Experiments of streams_bench ([what they are](README.md#streams-what-the-definitions-leave-open-and-how-it-was-settled-here)): 30 Hz,
640x480, in simulated time. A frame is felt 10 ms after its stamp; for methods of others it replaces the one before. \`video\`
is the graph on vertices that go in straight lines from frame to frame (Cha et al. 2006-09): one frame alone has no row of it.

EOF
  cat "$scratch/streams.md"
  cat <<EOF
## Events

Rows of events_bench, one drawn of each. *most* is the largest force, *least* and *last* are shares of the
force that should hold the hand, *lost* is the share of time with less than a fifth of it. *behind* is how long the proxy was more than
8 mm inside of something, *beyond* how far it was from all solids while it touched.

EOF
  cat "$scratch/events.md"
  cat <<EOF
## Any cloud

Rows of any_cloud_bench ([what they are](README.md#any-cloud-what-the-rows-are)), three drawn of each, at a spacing of 1 mm: medians,
worst in brackets. Methods on triangles need an image and have no line.

EOF
  cat "$scratch/clouds.md"
  cat <<EOF
## A recording

Flat parts of two frames of a RealSense camera ([what is asked](README.md#real-recordings)), each frame by itself.

EOF
  cat "$scratch/recording.md"
  cat <<EOF
## Computing times

On our index, in our programs, on a shared machine: what their authors' would take is not known. Two frames.

EOF
  cat "$scratch/times.md"
} >bench/RIVALS.md
say "bench/RIVALS.md is written"
