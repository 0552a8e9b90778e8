#!/usr/bin/env python3
"""Runs palpate in real time while other load rises and falls: soak.py PROGRAM [SECONDS].

Two simulated cameras and an exploring hand. Beside it 0 to 4 busy processes, one more or one less
every twentieth of the time. Fails when the program's memory grew (VmRSS: the median of the last tenth
over that of the third), when a step was a fault, or when the program did not end well.
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

MOST_GROWTH = 4e6  # bytes; what the allocator may keep
STAGES = 20
LOAD = [0, 1, 2, 3, 4, 3, 2, 1]  # busy processes, stage by stage, over and over
CAMERAS = ["left=camera:simulated:table,seed=1", "right=camera:simulated:table,seed=2,phase=0.011"]


def resident(pid):
    """VmRSS in bytes; None once the process is gone."""
    try:
        with open(f"/proc/{pid}/status", encoding="ascii") as status:
            for line in status:
                if line.startswith("VmRSS:"):
                    return 1024 * int(line.split()[1])
    except OSError:
        pass
    return None


class Load:
    """So many busy processes, as unimportant as they can be."""

    def __init__(self):
        self.busy = []

    def set(self, count):
        while len(self.busy) > count:
            process = self.busy.pop()
            process.kill()
            process.wait()
        while len(self.busy) < count:
            self.busy.append(subprocess.Popen(["nice", "-n", "19", sys.executable, "-c",
                                               "while True: pass"]))


def watch(program, seconds):
    """The program's memory, sample by sample, and which load there was."""
    load = Load()
    samples = []
    started = time.monotonic()
    try:
        while program.poll() is None:
            stage = int(STAGES * (time.monotonic() - started) / seconds)
            load.set(LOAD[stage % len(LOAD)])
            memory = resident(program.pid)
            if memory is not None:
                samples.append(memory)
            time.sleep(min(0.5, seconds / 100))
            if time.monotonic() - started > 3 * seconds + 60:
                program.kill()
    finally:
        load.set(0)
    return samples


def tell(run, growth, samples):
    live = run["live"]
    late = live["late_s"]
    print(f"{run['steps']} steps in {run['real_s']:.0f} s, {100 * run['contact_share']:.0f} % touching, "
          f"{live['steps_left_out']} left out; late p50 {1e3 * late['p50']:.3f} ms, "
          f"p99 {1e3 * late['p99']:.3f} ms, max {1e3 * late['max']:.1f} ms; faults {live['guard']['faults']}")
    for camera in run["sources"]:
        print(f"{camera['name']}: {camera['frames_touchable']} of {camera['frames']} frames touchable, "
              f"latency {1e3 * camera['latency_s']['p50']:.0f} ms, "
              f"{1e3 * camera['latency_s']['max']:.0f} ms at worst; "
              f"dropped {sum(camera['drops'].values())}")
    print(f"memory {max(samples) / 1e6:.1f} MB at most, grown by {growth / 1e6:+.2f} MB")


def main():
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    if len(sys.argv) < 2:
        print(__doc__)
        return 2
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 600
    with tempfile.TemporaryDirectory() as folder:
        report = os.path.join(folder, "run.json")
        with subprocess.Popen([sys.argv[1], "touch", *CAMERAS, "--duration", str(seconds), "--json", report],
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as program:
            samples = watch(program, seconds)
        if program.returncode != 0:
            print(f"palpate ended with {program.returncode}")
            return 1
        with open(report, encoding="utf-8") as file:
            run = json.load(file)
    tenth = max(len(samples) // 10, 1)
    growth = statistics.median(samples[-tenth:]) - statistics.median(samples[2 * tenth:3 * tenth])
    tell(run, growth, samples)
    bad = growth > MOST_GROWTH or run["live"]["guard"]["faults"] > 0
    print("FAILED: memory grew or a step was a fault" if bad else "passed")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
