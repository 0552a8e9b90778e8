#!/usr/bin/env python3
"""Computing time of servo steps and of preparation on real clouds, as a Markdown table.

    bench/step_times.py PALPATE FILE[,OPTION...] ... [--runs N] [--paths FOLDER]

Explores each FILE for ten simulated seconds, N times (5), with `palpate touch FILE OPTION...`, and
prints the medians over the runs. With --paths the way of the hand is kept in FOLDER and taken again
where it is there: so two builds of the program can be compared, each of which would explore its own
way. Step times are the processor time of SceneField::update and
Proxy::step together; `patch` is the median number of points in the patch while touching. An organised
cloud is prepared as a depth frame, which has no single R and no spacing.
"""

import argparse
import csv
import json
import pathlib
import statistics
import subprocess
import tempfile


def kept_path(program, file, options, paths):
    """Options that make the hand go as the first program went, with its stiffness."""
    path = paths / (pathlib.Path(file).name + ".csv")
    stiffness = path.with_suffix(".json")
    if not path.exists():
        command = [program, "touch", file, *options, "--log", str(path), "--json", str(stiffness)]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    newtons = json.loads(stiffness.read_text(encoding="utf-8"))["stiffness_N_per_m"]
    return ["--trajectory", str(path), "--stiffness", str(newtons)]


def one_run(program, file, options, folder):
    log = folder / "log.csv"
    report = folder / "report.json"
    command = [program, "touch", file, *options, "--log", str(log), "--json", str(report)]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    patches = []
    with log.open(encoding="utf-8", newline="") as rows:
        for row in csv.DictReader(rows):
            if row["touching"] == "1":
                patches.append(int(row["patch_points"]))
    return json.loads(report.read_text(encoding="utf-8")), statistics.median(patches or [0])


def summary(program, file, options, runs, folder):
    found = [one_run(program, file, options, folder) for _ in range(runs)]
    reports = [report for report, _ in found]
    cloud = reports[0]["sources"][0]

    def middle(value):
        return statistics.median(value(report) for report in reports)

    seconds = middle(lambda r: sum(r["sources"][0]["seconds"][k] for k in ("read", "prepare")))
    times = [middle(lambda r, p=p: r["computing_us"][p]) for p in ("p50", "p99", "p99.9", "max")]
    return [
        pathlib.Path(file).name,
        f"{cloud['points_felt']:,}".replace(",", " "),
        f"{cloud['radius_m']['median'] / cloud['spacing_m']:.1f}" if "radius_m" in cloud else "depth frame",
        f"{found[0][1]:.0f}",
        f"{seconds:.2f}",
        *(f"{t:.1f}" for t in times),
        f"{reports[0]['contact_share']:.0%}",
    ]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("files", nargs="+", help="FILE or FILE,OPTION,...")
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--paths", type=pathlib.Path, help="folder of ways that hands take again")
    arguments = parser.parse_args()
    print("| cloud | points felt | R / s | patch | read and ready, s | p50, us | p99 | p99.9 | max |"
          " touching |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for entry in arguments.files:
            file, *options = entry.split(",")
            if arguments.paths:
                options += kept_path(arguments.program, file, options, arguments.paths)
            row = summary(arguments.program, file, options, arguments.runs, pathlib.Path(folder))
            print("| " + " | ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main()
