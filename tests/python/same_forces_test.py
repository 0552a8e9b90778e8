"""A rollout gives the forces of the program's log, bit for bit."""

import csv
import subprocess
import tempfile
import unittest

import support
from support import np, pp


def logged(source, hand, times, *options):
    """The log of `palpate touch` with a scripted hand, as columns."""
    with tempfile.TemporaryDirectory() as folder:
        with open(f"{folder}/hand.csv", "w") as file:
            file.write("t,hip_x,hip_y,hip_z\n")
            file.writelines(f"{t!r},{x!r},{y!r},{z!r}\n" for t, (x, y, z) in zip(times.tolist(), hand.tolist()))
        command = [support.PROGRAM, "touch", f"cloud={source}", "--device", "scripted", "--trajectory", f"{folder}/hand.csv",
                   "--simulated-time", "--log", f"{folder}/log.csv", *options]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise AssertionError(done.stderr)
        with open(f"{folder}/log.csv") as file:
            rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def over(points):
    """A hand that presses onto a cloud's points, one after the other, from above and from a side."""
    generator = np.random.default_rng(5)
    low, high = points.min(axis=0), points.max(axis=0)
    size = np.linalg.norm(high - low)
    touched = points[generator.choice(len(points), 12)]
    keys = [high + 0.1 * size]
    for place in touched:
        away = generator.normal(size=3)
        away *= 0.05 * size / np.linalg.norm(away)
        keys += [place + away, place - 0.05 * away, place + away]
    steps = np.linspace(0, 1, 120, endpoint=False)[:, None]
    return np.concatenate([a + steps * (b - a) for a, b in zip(keys, keys[1:])])


@unittest.skipUnless(support.PROGRAM, "PALPATE_PROGRAM is not set")
class SameForces(unittest.TestCase):
    def compare(self, source, cloud, *options, field=None, proxy=None):
        scene = pp.Scene()
        added = scene.add("cloud", cloud)
        hand = over(added.points().points)
        times = np.arange(len(hand)) * 1e-3
        log = logged(source, hand, times, *options)
        rate = (len(times) - 1) / (times[-1] - times[0])  # as a scripted device has it: the first step takes one period
        out = pp.rollout(pp.Field(scene, **(field or {})), pp.Proxy(**(proxy or {})), hand, 1 / rate, time=times)
        self.assertGreater(int(out.touching.sum()), 50)
        for axis, name in enumerate("xyz"):
            np.testing.assert_array_equal(out.force[:, axis], log[f"f{name}"])
            np.testing.assert_array_equal(out.proxy[:, axis], log[f"proxy_{name}"])
            np.testing.assert_array_equal(out.normal[:, axis], log[f"n{name}"])
        for name in ("touching", "sliding", "stiffness", "iterations", "evaluations", "source", "notes", "field_notes"):
            np.testing.assert_array_equal(getattr(out, name).astype(float), log[name])

    def synthetic(self, name, *options, **settings):
        self.compare(f"synthetic:{name}", pp.synthetic_cloud(name), *options, **settings)

    def test_ball(self):
        self.synthetic("sphere")

    def test_torus_with_friction(self):
        self.synthetic("torus", "--friction-static", "0.4", "--friction-dynamic", "0.3",
                       proxy={"friction_static": 0.4, "friction_dynamic": 0.3})

    def test_bumps_as_metaball(self):
        self.synthetic("bumps", "--field", "metaball", field={"kind": "metaball"})

    def test_table_with_a_tool(self):
        self.synthetic("table", "--tool-radius", "0.001", field={"tool_radius": 0.001})

    def test_sheet_from_both_sides(self):
        self.synthetic("sheet", "--stiffness", "800", proxy={"stiffness": 800})

    def test_rabbit(self):
        self.synthetic("rabbit")

    def real(self, name):
        path = support.data(name)
        self.compare(path, path)

    def test_scan_of_a_bunny(self):
        self.real("pcl_tabletop/bun0.pcd")

    def test_organised_depths_of_a_table(self):
        self.real("pcl_tabletop/milk_cartoon_all_small_clorox.pcd")

    def test_thin_post(self):
        self.real("lamppost/lamppost.pcd")


support.main()
