#!/usr/bin/env python3
"""How long the Python module takes to import, and ticks a second of rollouts, by the thread's computing time: the
best of five.

PYTHONPATH=build/release/python bench/python_rollout.py"""

import subprocess
import sys
import time

import numpy as np
import palpate


def best(work, clock=time.thread_time):
    times = []
    for _ in range(5):
        start = clock()
        work()
        times.append(clock() - start)
    return min(times)


def slide(ticks, radius, depth):
    """Around a ball, `depth` m deep, 5 cm/s."""
    angle = np.arange(ticks) * (5e-5 / radius)
    hand = (radius - depth) * np.stack([np.cos(angle), np.zeros(ticks), np.sin(angle)], axis=1)
    hand[0] *= 1.5
    return hand


def report(what, field, hand):
    seconds = best(lambda: palpate.rollout(field, palpate.Proxy(), hand))
    print(f"{what:28} {len(hand) / seconds / 1e6:6.2f} M ticks/s")


started = best(lambda: subprocess.run([sys.executable, "-c", "import palpate"], check=True), time.perf_counter)
print(f"python3 -c 'import palpate' {started:6.2f} s")
flat = np.zeros((200_000, 3))
flat[:, 0] = np.arange(len(flat)) * 5e-5
flat[:, 2] = -1e-3
report("rollout on a plane", palpate.Plane(), flat)
report("rollout above a plane", palpate.Plane(), flat + (0, 0, 0.1))
report("rollout on a ball", palpate.Sphere(0.06), slide(200_000, 0.06, 2e-3))
scene = palpate.Scene()
scene.add("ball", palpate.synthetic_cloud("sphere"))
report("rollout on 11 309 points", palpate.Field(scene), slide(100_000, 0.06, 2e-3))
