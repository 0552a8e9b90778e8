"""Stamps of other clocks, times that are no numbers, and threads that outlive the interpreter."""

import math
import subprocess
import sys
import unittest

from support import main, np, pp

K = (375, 375, 79.5, 59.5)


def wall_felt(stamp_of, frames=12):
    """A hand 2 mm deep in a wall whose images have stamp_of(s): its largest force, and the problem."""
    scene = pp.Scene()
    camera = scene.add_camera("wall", K=K, size=(160, 120))
    field, proxy = pp.Field(scene), pp.Proxy(stiffness=500)
    proxy.reset((0, 0, 0.49))
    most = 0
    for k in range(frames):
        hand = np.full((33, 3), (0, 0, 0.49 if k < 3 else 0.502))
        camera.push(np.full((120, 160), 500, np.uint16), stamp_of(proxy.time))
        most = max(most, np.linalg.norm(pp.rollout(field, proxy, hand).force, axis=1).max())
    return most, camera.state().problem


class Stamps(unittest.TestCase):
    def test_those_of_the_proxys_clock_are_felt(self):
        force, problem = wall_felt(lambda t: t)
        self.assertGreater(force, 0.5)
        self.assertEqual(problem, "")

    def test_those_of_other_clocks_are_named(self):
        for unit in (1e3, 1e6, 1e9, 30):
            self.assertIn("proxy.time", wall_felt(lambda t: unit * t)[1], unit)
        for stamp_of in (lambda t: 1.7e9 + t, lambda t: None):
            force, problem = wall_felt(stamp_of)
            self.assertEqual(force, 0)
            self.assertIn("proxy.time", problem)

    def test_those_that_are_over_are_named(self):
        force, problem = wall_felt(lambda t: t - 5)
        self.assertEqual(force, 0)
        self.assertIn("proxy.time", problem)


class Times(unittest.TestCase):
    def test_a_step_of_no_time_is_a_fault_until_the_reset(self):
        for bad in (math.nan, math.inf, -1.0):
            proxy, field = pp.Proxy(), pp.Plane()
            proxy.step(field, (0, 0, 0.01), dt=1e-3)
            self.assertIn("fault", pp.note_names(proxy.step(field, (0, 0, 0.01), dt=bad).notes), bad)
            self.assertEqual(proxy.time, 1e-3)
            proxy.reset((0, 0, 0.01))
            proxy.step(field, (0, 0, -0.01), dt=1e-3)
            self.assertGreater(proxy.step(field, (0, 0, -0.01)).force[2], 0)
            self.assertAlmostEqual(proxy.time, 3e-3)


ENDS = """
import threading, time
import numpy as np
import palpate as pp
def touch():
    while True:
        pp.rollout(pp.Plane(), pp.Proxy(), np.zeros((TICKS, 3)))
for _ in range(4):
    threading.Thread(target=touch, daemon=True).start()
time.sleep(0.2)
print("end")
"""


class Threads(unittest.TestCase):
    def test_daemons_within_a_rollout_let_the_interpreter_end(self):
        for ticks in (100, 20_000, 1_000_000):
            code = ENDS.replace("TICKS", str(ticks))
            ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
            self.assertEqual((ended.returncode, ended.stdout, ended.stderr), (0, "end\n", ""), ticks)


main()
