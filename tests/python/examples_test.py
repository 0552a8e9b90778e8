"""The examples run, the notebook among them, and the teleoperator is one to a double of LeRobot."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

from support import ball, main, np, pp, stroke

HERE = pathlib.Path(__file__).resolve().parent
EXAMPLES = HERE.parents[1] / "examples" / "python"
sys.path += [str(HERE / "double"), str(EXAMPLES / "lerobot_teleoperator_palpate")]


def run(*command):
    done = subprocess.run([sys.executable, *command], capture_output=True, text=True, env={**os.environ, "MPLBACKEND": "Agg"})
    if done.returncode:
        raise AssertionError(done.stderr)
    return done.stdout


def needs_matplotlib():
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise unittest.SkipTest("matplotlib is absent")


class Examples(unittest.TestCase):
    def test_ten_lines(self):
        self.assertRegex(run(EXAMPLES / "ten_lines.py"), r"largest force 2\.\d+ N")

    def test_depth_camera(self):
        self.assertRegex(run(EXAMPLES / "depth_camera.py"), r"largest force [0-9.]*[1-9][0-9.]* N")

    def test_surfaces(self):
        self.assertEqual(len(run(EXAMPLES / "compare_surfaces.py").splitlines()), 3)

    def test_picture(self):
        needs_matplotlib()
        with tempfile.TemporaryDirectory() as folder:
            run(EXAMPLES / "compare_surfaces.py", f"{folder}/a.png")
            self.assertGreater(os.path.getsize(f"{folder}/a.png"), 10_000)
        pp.plot(pp.synthetic_cloud("sphere"))
        with self.assertRaises(TypeError):
            pp.plot(3)

    def test_a_contact_is_drawn_to_one_scale(self):
        needs_matplotlib()
        axes = pp.plot(pp.rollout(pp.Field(ball()), pp.Proxy(), stroke())).axes[0]
        spans = [np.ptp(limits) for limits in (axes.get_xlim(), axes.get_ylim(), axes.get_zlim())]
        self.assertLess(max(spans), 1.001 * min(spans))


class Notebook(unittest.TestCase):
    def setUp(self):
        self.cells = json.loads((EXAMPLES / "figure_7.ipynb").read_text())["cells"]

    def test_is_stripped(self):
        for cell in self.cells:
            self.assertFalse(cell.get("outputs") or cell.get("execution_count"))

    def test_gives_the_figure(self):
        needs_matplotlib()
        code = "\n".join("".join(cell["source"]) for cell in self.cells if cell["cell_type"] == "code")
        lines = run("-c", code.replace("SECONDS = 3.0", "SECONDS = 0.5")).splitlines()
        height = {line[:11].strip(): float(line.split("height sd")[1].split()[0]) for line in lines}
        self.assertEqual(len(height), 9)
        self.assertLess(height["metaball 4"], height["metaball 1"])
        self.assertLess(10 * height["palpate"], height["pointset 4"])


class Teleoperator(unittest.TestCase):
    def test_is_found_and_works(self):
        import lerobot_teleoperator_palpate as plug_in
        from lerobot.teleoperators.config import CHOICES

        config = CHOICES["palpate"](id="mine")
        self.assertEqual(type(config).__name__, "PalpateTeleoperatorConfig")
        teleoperator = plug_in.PalpateTeleoperator(config)
        with self.assertRaises(ConnectionError):
            teleoperator.get_action()
        teleoperator.connect()
        try:
            self.assertTrue(teleoperator.is_connected and teleoperator.is_calibrated)
            action = teleoperator.get_action()
            self.assertEqual(action.keys(), teleoperator.action_features.keys())
            self.assertTrue(all(isinstance(value, float) and np.isfinite(value) for value in action.values()))
            for _ in range(1000):
                teleoperator.send_feedback({"force.x": 2.0, "force.y": 0.0, "force.z": 0.0})
                if teleoperator.servo.state().force[0] > 0.1:
                    break
            self.assertGreater(teleoperator.servo.ticks().force[:, 0].max(), 0)
        finally:
            teleoperator.disconnect()
        self.assertFalse(teleoperator.is_connected)


main()
