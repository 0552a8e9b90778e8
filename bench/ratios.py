#!/usr/bin/env python3
"""Prints the table of medians and ratios from Google Benchmark's JSON files.

    geometry_bench --benchmark_repetitions=7 --benchmark_out=run.json --benchmark_out_format=json
    bench/ratios.py run.json [more.json ...]

Rows are named estimator/who/points; the ratio is who's median over palpate's. The time is the
thread's processor time, which other work on the machine disturbs least.
"""

import json
import statistics
import sys

MILLISECONDS = {"ns": 1e-6, "us": 1e-3, "ms": 1, "s": 1e3}


def medians(files):
    """{(estimator, points): {who: (ms, counters)}}, in the order of the files."""
    times = {}
    for name in files:
        with open(name, encoding="utf-8") as file:
            runs = json.load(file)["benchmarks"]
        aggregated = any(run.get("aggregate_name") == "median" for run in runs)
        for run in runs:
            if run.get("error_occurred") or (aggregated and run.get("aggregate_name") != "median"):
                continue
            estimator, who, points = run["run_name"].split("/")[:3]
            row = times.setdefault((estimator, int(points)), {})
            time = run["cpu_time"] * MILLISECONDS[run["time_unit"]]
            row.setdefault(who, ([], run))[0].append(time)
    return {
        key: {who: (statistics.median(list_), run) for who, (list_, run) in row.items()}
        for key, row in times.items()
    }


def readable(milliseconds):
    if milliseconds < 0.01:
        return f"{milliseconds * 1e6:.0f} ns"
    return f"{milliseconds:.2f} ms" if milliseconds < 1000 else f"{milliseconds / 1000:.2f} s"


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    print("| estimator | points | who | time | ratio to palpate |")
    print("|---|---|---|---|---|")
    notes = []
    for (estimator, points), row in medians(sys.argv[1:]).items():
        if "palpate" not in row:
            continue
        ours = row["palpate"][0]
        for who, (time, run) in row.items():
            ratio = "" if who == "palpate" else f"{time / ours:.1f}"
            print(f"| {estimator} | {points} | {who} | {readable(time)} | {ratio} |")
            if "p99_degrees_to_pcl" in run:
                notes.append(
                    f"{estimator}, {points} points, against PCL's: 99th percentile "
                    f"{run['p99_degrees_to_pcl']:.2g} degrees, largest "
                    f"{run['max_degrees_to_pcl']:.2g}, flips {run['flips_to_pcl']:.0f}."
                )
    print()
    print("\n".join(notes))


if __name__ == "__main__":
    main()
