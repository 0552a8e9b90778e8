#!/usr/bin/env bash
# Measures everything that bench/RESULTS.md holds, in one run, and writes it there: first what needs an idle machine,
# then what says the same on any.
#
# bench/run_all.sh   needs the packages of scripts/packages.txt (groups build, test, bench); real
#                    clouds are looked for in $PALPATE_DATA, else in ../shared/data, and left out
#                    with a word where they are absent
# Quote ratios and medians: other work on the machine shifts single times.
# shellcheck source=scripts/lib.sh
source "$(dirname "$0")/../scripts/lib.sh"
need_packages build test bench
find_data

say "build"
configure release -DPALPATE_BUILD_BENCH=ON
build release geometry_bench field_bench depth_bench accuracy_bench streams_bench events_bench robot_bench any_cloud_bench four_cameras_bench viewer_bench device_bench palpate_app
programs=build/release
commit=$(git rev-parse --short HEAD)  # which may be another one hours later
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

speed() {
  "$programs/bench/$1" --benchmark_repetitions=7 --benchmark_min_time=0.05 \
    --benchmark_report_aggregates_only=true --benchmark_out_format=json \
    --benchmark_out="$scratch/$1.json" >/dev/null 2>&1
}

clouds() {
  if [ -z "${PALPATE_DATA:-}" ]; then
    echo "Left out: no real clouds were there."
    return
  fi
  local lidar=$scratch/autzen.las
  xz -dkc "$PALPATE_DATA/autzen_10m/autzen.las.xz" >"$lidar"
  bench/step_times.py "$programs/apps/palpate/palpate" \
    "$PALPATE_DATA/stanford_bunny/bun_zipper.ply" "$PALPATE_DATA/stanford_dragon/dragon_vrip.ply.gz" \
    "$PALPATE_DATA/pcl_tabletop/osd_test7.pcd" \
    "$PALPATE_DATA/pcl_tabletop/milk_cartoon_all_small_clorox.pcd" "$lidar,--scale,0.3048"
  echo
  echo "The LiDAR at its most: $(/usr/bin/env python3 - "$programs/apps/palpate/palpate" "$lidar" <<'PY'
import resource, subprocess, sys
subprocess.run([sys.argv[1], "touch", sys.argv[2], "--scale", "0.3048", "--duration", "1"], check=True,
               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
print(f"{resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1e6:.2f} GB of memory")
PY
)."
}

say "speed beside other libraries"
speed geometry_bench
speed field_bench
speed depth_bench
"$programs/bench/depth_bench" --two-threads --benchmark_repetitions=7 --benchmark_min_time=0.05 \
  --benchmark_format=json 2>/dev/null >"$scratch/two_threads.json"
say "steps on real clouds"
clouds >"$scratch/clouds.md"
say "four cameras"
cameras=$programs/bench/four_cameras/four_cameras_bench
"$cameras" --pairs 0 >"$scratch/shared.md"
"$cameras" --processor $(($(nproc) - 1)) >"$scratch/apart.md" || true  # it says what was missed
say "devices"
"$programs/bench/devices/device_bench" --benchmark_counters_tabular=true >"$scratch/devices.txt"
say "the viewer"
"$programs/bench/viewer/viewer_bench" --seconds 20 --processor $(($(nproc) - 1)) >"$scratch/viewer.md" || true
load=$(cut -d' ' -f1 /proc/loadavg)
say "accuracy"
for noise in a b; do
  "$programs/bench/accuracy/accuracy_bench" --noise "$noise" >"$scratch/$noise.md"
done
say "streams"
"$programs/bench/streams/streams_bench" >"$scratch/streams.md"
say "events"
"$programs/bench/events/events_bench" >"$scratch/events.md"
"$programs/bench/robot/robot_bench" >"$scratch/robot.md"
say "any cloud"
"$programs/bench/any_cloud/any_cloud_bench" >"$scratch/any_cloud.txt"

{
  cat <<EOF
# Results

$(date +%Y-%m-%d), commit $commit, $(nproc) cores ($(awk -F': ' '/model name/ { print $2; exit }' /proc/cpuinfo)), load
$load after the timed parts, $(g++ --version | head -n 1), Release. What the rows mean and what was settled: [README.md](README.md).
All of it in one run of

    bench/run_all.sh

What was measured while something was decided, before and after it, is in [notes](notes/README.md).

## Speed beside other libraries

One thread, medians of seven repetitions of processor time, peers at the same compiler flags.

$(bench/ratios.py "$scratch/geometry_bench.json" "$scratch/field_bench.json" "$scratch/depth_bench.json")

The last rows are of a decoded 640x480 depth frame in memory: \`touchable\` until its snapshot is
published, \`filter\` the depth filter alone. With the fit everywhere on two threads a frame takes
$(python3 -c 'import json, statistics, sys
runs = json.load(open(sys.argv[1]))["benchmarks"]
times = [r["real_time"] for r in runs if r["run_type"] == "iteration"]
print(f"{statistics.median(times):.1f}")' "$scratch/two_threads.json") ms of wall time.

## Steps and preparation on real clouds

$(cat "$scratch/clouds.md")

## Accuracy on depth frames with known truth

One raw frame, taken as a depth frame (\`organised\`, the default for cameras) and as unorganised points
(\`balanced\`, the default for clouds, and the rest). CHAI3D's column is quoted (best of three tuned meshes,
each metric apart), not run here.

$(cat "$scratch/a.md")

$(cat "$scratch/b.md")

## Depth streams with known truth

30 Hz, 640x480, noise a unless said, in simulated time: a frame is felt 10 ms after its stamp. Forces are the
raw K (p - h).

$(cat "$scratch/streams.md")

## What happens in a stream

Medians over seeds, and the worst in brackets; layouts, poses and paths are drawn from the seed.

$(cat "$scratch/events.md")

### What a robot is told

$(cat "$scratch/robot.md")

## Any cloud

\`\`\`
$(cat "$scratch/any_cloud.txt")
\`\`\`

## Four cameras beside the servo

In real time: four cameras at 30 Hz, the servo at 1 kHz. The system shares out the processors:

$(cat "$scratch/shared.md")

The servo has a processor of its own, preparation the others:

$(cat "$scratch/apart.md")

## The viewer beside the servo

In real time: a cloud of 300 000 points, a servo at 1 kHz on a processor of its own, a viewer with eight clients on
the others.

$(cat "$scratch/viewer.md")

## Devices

\`exchange/DRIVER\`: one exchange of a force for a place with the tests' double, wall time; \`step/CLOUD\`: computing time of a
servo's step with every guard on while a simulated hand explores for a minute.

\`\`\`
$(cat "$scratch/devices.txt")
\`\`\`
EOF
} >bench/RESULTS.md
say "bench/RESULTS.md is written"
