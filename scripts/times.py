#!/usr/bin/env python3
"""What a build and its tests took, from ninja's log and from what test programs and ctest leave.

times.py BUILD              tables in Markdown: units that compiled longest, entries of ctest, the thirty slowest cases
times.py --slowest N BUILD  the N slowest cases, a line each
times.py --failed BUILD     the commands that run what failed, one at a time
times.py --budget BUILD     fails if a case outside of the label "long" takes more than 5 s of processor time
"""

import argparse
import pathlib
import re
import sys
import time

BUDGET = 5.0  # s of processor time, on the machine where REFERENCE was measured
TOLERANCE = 1.5  # the same case took up to so many times as long beside other work, which shares caches and memory
REFERENCE = 0.45  # s that reference_work() takes on one core of an AMD EPYC (Zen 4) at 2.6 GHz


def units(build):
    """(seconds, file) of what ninja made last, the slowest first."""
    log = build / ".ninja_log"
    made = {}
    for line in log.read_text(encoding="utf-8").splitlines() if log.exists() else []:
        if not line.startswith("#"):
            start, end, _, output, _ = line.split("\t")
            made[output] = (int(end) - int(start)) / 1e3
    return sorted(((seconds, name) for name, seconds in made.items()), reverse=True)


def cases(build):
    """(seconds, seconds of processor time, end, program, case) of each case that a test program ran."""
    found = []
    for path in sorted((build / "times").glob("*.tsv")):
        for line in path.read_text(encoding="utf-8").splitlines():
            name, *rest = line.split("\t")
            wall, processor, end = rest if rest else ("0", "0", "crashed")
            found.append((float(wall), float(processor), end, path.stem, name))
    return found


def entries(build):
    """(seconds, result, name) of what ctest ran last, the slowest first."""
    log = build / "Testing" / "Temporary" / "LastTest.log"
    text = log.read_text(encoding="utf-8", errors="replace") if log.exists() else ""
    exact = dict(re.findall(r"^\d+/\d+ Test: (\S+)$[\s\S]*?^Test time = +([\d.]+) sec", text, re.M))
    ended = dict(re.findall(r"^\d+/\d+ Test: (\S+)$[\s\S]*?^Test (Passed|Failed|Skipped)", text, re.M))
    return sorted(((float(seconds), ended.get(name, "Failed"), name) for name, seconds in exact.items()), reverse=True)


def sources(root):
    """(suite, case) to its file, line and the comment above it."""
    found = {}
    for path in sorted((root / "tests").rglob("*_test.cpp")):
        lines = path.read_text(encoding="utf-8").splitlines()
        for number, line in enumerate(lines):
            head = re.match(r"(?:TYPED_)?TEST(?:_[FP])?\((\w+), *(\w+)?", line)
            if not head:
                continue
            name = head[2] or re.match(r" *(\w+)", lines[number + 1])[1]
            first = number
            while first > 0 and lines[first - 1].startswith("//"):
                first -= 1
            found[head[1], name] = path, number + 1, " ".join(text.lstrip("/ ") for text in lines[first:number])
    return found


def proves(case, known):
    """What a case proves: its name as a sentence, and the comment above it."""
    parts = [part for part in re.split(r"[./]", case) if not part.isdigit()]
    suite, name = next(((s, n) for s in parts for n in parts if (s, n) in known), (parts[0], parts[-1]))
    sentence = re.sub(r"(?<=[a-z\d])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", " ", name).lower()
    comment = known.get((suite, name), (None, 0, ""))[2]
    return f"{sentence}. {comment}".strip()


def report(build, root):
    known = sources(root)
    print("| what was compiled or linked | s |\n|---|---|")
    made = units(build)
    print(f"| all {len(made)} of it, one after another | {sum(seconds for seconds, _ in made):.0f} |")
    for seconds, name in made[:30]:
        print(f"| {re.sub(r'CMakeFiles/|.dir|_cxx.cxx.o$', '', name)} | {seconds:.1f} |")
    print("\n| entry of ctest | s |\n|---|---|")
    for seconds, _, name in entries(build)[:40]:
        print(f"| {name} | {seconds:.1f} |")
    print("\n| case | s | s of processor time | what it proves |\n|---|---|---|---|")
    for wall, processor, _, program, name in sorted(cases(build), reverse=True)[:30]:
        print(f"| {program} {name} | {wall:.1f} | {processor:.1f} | {proves(name, known)} |")


def failed(build):
    programs = {path.stem: path for path in build.glob("tests/**/*_test") if path.is_file()}
    for _, _, end, stem, name in cases(build):
        if end in {"failed", "crashed"}:
            program = programs.get(re.sub(r"_long$|_\d+$", "", stem) + "_test", stem)
            print(f"{end}: {program} --gtest_filter='{name}'")
    for _, end, name in entries(build):
        if end == "Failed":
            print(f"failed: ctest --test-dir {build} --output-on-failure -R '^{name}$'")


def reference_work():
    start = time.process_time()
    total = 0
    for i in range(10_000_000):
        total += i & 7
    return time.process_time() - start


def budget(build):
    """A slower processor has more time; a busy one, too, for what is measured is processor time."""
    limit = TOLERANCE * BUDGET * max(1.0, reference_work() / REFERENCE)
    short = [case for case in cases(build) if not case[3].endswith("_long")]
    over = sorted((case for case in short if case[1] > limit), reverse=True)
    for wall, processor, _, program, name in over:
        print(f"{program} {name}: {processor:.1f} s of processor time, more than {limit:.1f}: "
              "name it in LONG of its program's palpate_test(), or make it shorter")
    print(f"{len(short)} cases take {sum(case[1] for case in short):.0f} s of processor time, "
          f"{len(over)} of them more than {limit:.1f} s each")
    if not short:
        print(f"no test program has left its times in {build / 'times'}: run the tests first")
    return 1 if over or not short else 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, help="a build folder, such as build/release")
    parser.add_argument("--slowest", type=int, metavar="N")
    parser.add_argument("--failed", action="store_true")
    parser.add_argument("--budget", action="store_true")
    options = parser.parse_args()
    if not options.build.is_dir():
        parser.error(f"{options.build} is no folder")
    if options.budget:
        return budget(options.build)
    if options.failed:
        failed(options.build)
    elif options.slowest:
        for wall, _, _, program, name in sorted(cases(options.build), reverse=True)[:options.slowest]:
            print(f"{wall:5.1f} s  {program}  {name}")
    else:
        report(options.build, pathlib.Path(__file__).resolve().parents[1])
    return 0


if __name__ == "__main__":
    sys.exit(main())
