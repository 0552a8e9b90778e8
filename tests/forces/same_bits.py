#!/usr/bin/env python3
"""same_bits.py NATIVE COMMAND... -- ARGUMENT...: do both programs print the same? 77: there is no native one."""

import pathlib
import subprocess
import sys


def printed(command):
    """The lines that a program prints; what it says beside them is passed on."""
    ended = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if ended.returncode != 0:
        sys.exit(f"{' '.join(command)}: ended with {ended.returncode}")
    return ended.stdout.splitlines()


def main(native, *rest):
    split = rest.index("--")
    command, arguments = list(rest[:split]), list(rest[split + 1:])
    if not pathlib.Path(native).is_file():
        print(f"no native program to compare with: \"{native}\"; scripts/tab.sh builds it")
        return 77
    expected, found = printed([native, *arguments]), printed([*command, *arguments])
    different = [i for i, (a, b) in enumerate(zip(expected, found)) if a != b]
    steps = [line.split() for line in expected if line.count(" ") == 4]
    touching = sum(step[3] == "1" for step in steps)
    if touching < len(steps) / 10:
        sys.exit(f"{arguments[0]}: of {len(steps)} steps only {touching} touch: no force is compared")
    if len(expected) == len(found) and not different:
        print(f"{arguments[0]}: {len(found)} lines, the same; {touching} of {len(steps)} steps touch")
        return 0
    print(f"{arguments[0]}: {len(different)} of {len(expected)} lines differ ({len(found)} printed)")
    for i in different[:3]:
        print(f"line {i + 1}:\n  {expected[i]}\n  {found[i]}")
    return 1


sys.exit(main(*sys.argv[1:]))
