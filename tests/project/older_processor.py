"""Runs the program as an x86-64-v2 processor (Nehalem) would, or another: older_processor.py PROGRAM FOLDER [CPU].

Nothing newer than what it has (SSE4.2) may be executed, and the forces have to be those of this machine, bit for
bit: loops that are compiled twice add in the same order in both.
"""

import csv
import pathlib
import shutil
import subprocess
import sys

SKIPPED = 77  # what CMake takes for skipped
EMULATOR = ["qemu-x86_64", "-cpu", sys.argv[3] if len(sys.argv) > 3 else "Nehalem"]
CLOUDS = ["synthetic:bumps", "synthetic:torus"]


def touch(prefix, program, cloud, log):
    """The log of a touch as rows of text, without the computing times."""
    command = [*prefix, program, "touch", cloud, "--duration", "1", "--log", str(log)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} ended with {done.returncode}:\n{done.stdout}{done.stderr}")
    with open(log, encoding="utf-8", newline="") as file:
        rows = list(csv.reader(file))
    times = rows[0].index("us")
    return [row[:times] + row[times + 1:] for row in rows]


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    if not shutil.which(EMULATOR[0]):
        print(f"Skipped: {EMULATOR[0]} is absent (Debian: qemu-user)")
        return SKIPPED
    folder.mkdir(parents=True, exist_ok=True)
    for cloud in CLOUDS:
        here = touch([], program, cloud, folder / "here.csv")
        older = touch(EMULATOR, program, cloud, folder / "older.csv")
        if len(here) < 1000:
            sys.exit(f"{cloud}: {len(here)} rows only")
        for number, (row, other) in enumerate(zip(here, older, strict=True), 1):
            if row != other:
                sys.exit(f"{cloud}: row {number} differs:\n{row}\n{other}")
        print(f"{cloud}: {len(here)} rows are the same")
    return 0


if __name__ == "__main__":
    sys.exit(main())
