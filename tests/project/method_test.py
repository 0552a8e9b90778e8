"""Tests docs/method.md: sections 2 to 4 written from its text in plain Python (scripts/drawings) give the program's surface and forces."""

import csv
import math
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts" / "drawings"))
from faces import prepare_faces  # noqa: E402
from gaps import prepare_anywhere  # noqa: E402
from proxy import Proxy  # noqa: E402
from sources import prepare_sources  # noqa: E402
from surface import length, minus, prepare  # noqa: E402

SAME_FORCE = 0.01  # N
SAME_PLACE = 0.01  # R


def over_a_ball(count, least):
    """A hand that comes to a ball of 50 mm, strokes it `least` m from its centre, and leaves."""
    hands = []
    for k in range(count):
        angle, r = 1.2 * k / (count - 1), 0.085 - (0.085 - least) * math.sin(math.pi * k / (count - 1))
        hands.append((r * math.cos(angle) * math.cos(0.3), r * math.cos(angle) * math.sin(0.3), r * math.sin(angle)))
    return hands


def ball(count, radius, noise=0.0):
    """A spiral of points on a sphere, in m."""
    chance = random.Random(3)
    points = []
    for i in range(count):
        z = 1 - (2 * i + 1) / count
        angle, around = i * math.pi * (3 - math.sqrt(5)), math.sqrt(1 - z * z)
        r = radius + noise * (2 * chance.random() - 1)
        points.append([r * around * math.cos(angle), r * around * math.sin(angle), r * z])
    return points


def ball_at_random(count, radius, seed):
    """Points anywhere on a sphere, in m."""
    chance = random.Random(seed)
    points = [[chance.gauss(0, 1) for _ in range(3)] for _ in range(count)]
    return [[radius * x / length(p) for x in p] for p in points]


def waves(side, spacing):
    """A jittered wavy sheet."""
    chance = random.Random(5)
    places = [[spacing * (k - side / 2 + 0.3 * (2 * chance.random() - 1)) for k in pair]
              for pair in ((i, j) for i in range(side) for j in range(side))]
    return [[x, y, 3e-3 * math.sin(60 * x) * math.cos(40 * y)] for x, y in places]


def floor_and_wall(side, spacing, up):
    """A floor, and a wall that meets it at a right angle: above it (up 1) or below (-1)."""
    along = [[spacing * (i + 0.5), spacing * (j - side / 2 + 0.5)] for i in range(side) for j in range(side)]
    return [[-a, b, 0.0] for a, b in along] + [[0.0, b, up * a] for a, b in along]


class Method(unittest.TestCase):
    def compare(self, points, hands, *options, kind="balanced", tool=0.0, friction=(0.0, 0.0, 0.0), prepared=prepare):
        """Steps both through the hand's positions; returns how many of the program's touched."""
        with tempfile.TemporaryDirectory() as folder:
            clouds = [f"{folder}/cloud{k}.txt" for k in range(len(points) if prepared is prepare_sources else 1)]
            for cloud, column in zip(clouds, points if prepared is prepare_sources else [points]):
                pathlib.Path(cloud).write_text("".join("{:.9f} {:.9f} {:.9f}\n".format(*p) for p in column), encoding="utf-8")
            way, log = f"{folder}/way.csv", f"{folder}/log.csv"
            rows = "".join("{:.3f},{:.12f},{:.12f},{:.12f}\n".format(k * 1e-3, *h) for k, h in enumerate(hands))
            pathlib.Path(way).write_text("t,hip_x,hip_y,hip_z\n" + rows, encoding="utf-8")
            subprocess.run([os.environ["PALPATE_PROGRAM"], "touch", *clouds, "--trajectory", way, "--log", log, "--simulated-time",
                            "--no-view", *options], check=True, capture_output=True)
            with open(log, encoding="utf-8") as file:
                steps = list(csv.DictReader(file))
        self.assertEqual(len(steps), len(hands))
        surface = prepared(points, hands[0])
        surface.kind, surface.tool = kind, tool
        proxy = Proxy(surface, friction=friction)
        for k, (hand, step) in enumerate(zip(hands, steps)):
            force = proxy.step(list(hand))
            self.assertEqual(proxy.normal is not None, step["touching"] == "1", k)
            self.assertLess(length(minus(force, [float(step[name]) for name in ("fx", "fy", "fz")])), SAME_FORCE, k)
            place = [float(step[f"proxy_{axis}"]) for axis in "xyz"]
            self.assertLess(length(minus(proxy.position, place)), SAME_PLACE * surface.smallest, k)
        return sum(step["touching"] == "1" for step in steps)

    def test_a_hand_that_presses_strokes_and_leaves_a_ball(self):
        self.assertGreater(self.compare(ball(300, 0.05), over_a_ball(150, 0.045)), 40)

    def test_a_hand_that_goes_over_an_edge_and_down(self):
        hands = []
        for k in range(150):
            over, back, down = min(1, k / 50), min(1, max(0, (k - 50) / 20)), max(0, (k - 70) / 80)
            hands.append((-0.01 + 0.02 * over - 0.014 * back, 3e-3, 5e-3 - 0.012 * min(1, max(0, (k - 20) / 30)) - 0.02 * down))
        self.assertGreater(self.compare(floor_and_wall(12, 4e-3, -1), hands, prepared=prepare_faces), 60)

    def test_a_hand_that_goes_into_a_crease_and_up(self):
        hands = [(-0.03 + 0.034 * min(1, k / 75), 3e-3, 0.01 - 0.013 * min(1, k / 20) + 0.02 * max(0, (k - 75) / 75)) for k in range(150)]
        self.assertGreater(self.compare(floor_and_wall(12, 4e-3, 1), hands, prepared=prepare_faces), 100)

    def test_two_scans_that_overlap_half_a_millimetre_apart(self):
        chance = random.Random(1)
        scans = [[[spacing * (i + 0.2 * (2 * chance.random() - 1)), spacing * (j + 0.2 * (2 * chance.random() - 1)), height]
                  for i in range(first, first + 17) for j in range(-6, 7)] for spacing, height, first in ((4e-3, 0.0, -13), (3e-3, 5e-4, -5))]
        hands = [(-0.03 + 0.06 * k / 149, 2e-3, 0.01 - 0.014 * min(1, k / 25)) for k in range(150)]
        self.assertGreater(self.compare(scans, hands, prepared=prepare_sources), 100)

    def test_points_that_lie_anywhere(self):
        for count, seed in ((300, 3), (160, 1)):
            self.assertGreater(self.compare(ball_at_random(count, 0.05, seed), over_a_ball(150, 0.045), prepared=prepare_anywhere), 40)

    def test_other_fields_and_a_tool(self):
        points, hands = ball(300, 0.05), over_a_ball(60, 0.045)
        self.assertGreater(self.compare(points, hands, "--field", "pointset", kind="point-set"), 10)
        self.assertGreater(self.compare(points, hands, "--field", "metaball", "--tool-radius", "0.005", kind="metaball", tool=0.005), 10)
        self.assertGreater(self.compare(points, hands, "--tool-radius", "0.005", tool=0.005), 10)

    def test_friction(self):
        options = ("--friction-static", "0.6", "--friction-dynamic", "0.4", "--friction-viscous", "3")
        self.assertGreater(self.compare(ball(300, 0.05), over_a_ball(150, 0.045), *options, friction=(0.6, 0.4, 3.0)), 40)

    def test_noisy_points(self):
        hands = [(0.065 - 0.02 * math.sin(math.pi * k / 99), 4e-3 * k / 99, 2e-3) for k in range(100)]
        self.assertGreater(self.compare(ball(300, 0.05, noise=4e-4), hands), 40)

    def test_a_hand_that_is_pressed_through_a_ball(self):
        hands = [(0.12 - 0.2 * k / 59, 4e-3, 2e-3) for k in range(60)]
        self.assertGreater(self.compare(ball(300, 0.05), hands), 20)

    def test_a_hand_that_slides_off_a_wavy_sheet(self):
        hands = [(-0.02 + 0.08 * k / 149, 0.01 * math.sin(9 * k / 149), 0.01 - 0.016 * min(1, k / 25)) for k in range(150)]
        touching = self.compare(waves(17, 4e-3), hands)
        self.assertGreater(touching, 60)
        self.assertLess(touching, 130)


if __name__ == "__main__":
    unittest.main()
