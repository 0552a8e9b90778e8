"""Servos run on threads of their own, whatever becomes of what they were made of, and end with the interpreter."""

import gc
import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

from support import ball, main, np, pp, stroke

FAKE = os.environ.get("PALPATE_FAKE_DHD")
CLIENT = pathlib.Path(__file__).resolve().parents[2] / "examples" / "remote_device_client.py"


def wait_for(condition, what):
    """Until it is so; a minute is none of a test's assertions, but the end of its patience."""
    for _ in range(6000):
        if condition():
            return
        time.sleep(0.01)
    raise AssertionError(f"waited in vain for: {what}")


def threads():
    return len(os.listdir("/proc/self/task"))


class Running(unittest.TestCase):
    def test_hand_touches(self):
        with pp.Servo(ball(), hand=stroke(), stiffness=300, soft_start=0) as servo:
            wait_for(lambda: np.linalg.norm(servo.state().force) > 0, "a force")
            self.assertTrue(servo.running and servo.problem == "" and "simulated" in repr(servo))
        self.assertFalse(servo.running)
        ticks = servo.ticks()
        np.testing.assert_array_equal(np.diff(ticks.step), 1)
        self.assertEqual(ticks["force"].shape, (len(ticks), 3))
        self.assertTrue(np.isfinite(ticks.force).all() and ticks.touching.any())
        self.assertEqual(len(servo.ticks()), 0)
        servo.stop()

    def test_added_force_goes_through_the_guard(self):
        with pp.Servo(ball(), maximum_force=1, soft_start=0, pose=np.eye(4)) as servo:
            def pushed():
                servo.add_force((0, 5, 0))
                return servo.state().force[1] > 0.5
            wait_for(pushed, "the added force")
            self.assertLessEqual(np.linalg.norm(servo.ticks().force, axis=1).max(), 1 + 1e-9)
            wait_for(lambda: abs(servo.state().force[1]) < 1e-6, "its end")
            with self.assertRaisesRegex(pp.Error, "finite"):
                servo.add_force((np.nan, 0, 0))

    def test_hand_is_moved(self):
        with pp.Servo(ball(), hand=np.array([[0, 0, 0.1]])) as servo:
            servo.move((0.1, 0, 0.1))
            wait_for(lambda: np.linalg.norm(servo.state().hip - (0.1, 0, 0.1)) < 5e-3, "the hand")
            with self.assertRaises(pp.Error):
                servo.move((np.inf, 0, 0))

    def test_settings_change_while_it_runs(self):
        with pp.Servo(ball(), hand=stroke(radius=0.055)) as servo:
            servo.set_contact(stiffness=100, friction_static=0.3, friction_dynamic=0.2)
            servo.set_field(kind="metaball")
            wait_for(lambda: servo.state().touching and servo.state().stiffness <= 100, "a soft contact")
            servo.pause()
            wait_for(lambda: servo.state().paused and not servo.state().force.any(), "no force")
            with self.assertRaises(pp.Error):
                servo.set_contact(stiffness=-1)

    def test_scene_is_dropped(self):
        servo = pp.Servo(ball(), hand=stroke())
        gc.collect()
        pp.prepare(pp.synthetic_cloud("rabbit"))
        wait_for(lambda: servo.state().touching, "contact with a scene that nobody else holds")

    def test_servo_is_dropped(self):
        scene = ball()
        before = threads()
        for _ in range(5):
            servo = pp.Servo(scene)
            self.assertGreater(threads(), before)
            del servo
            wait_for(lambda: threads() <= before, "the end of its thread")

    @unittest.skipUnless(FAKE, "PALPATE_FAKE_DHD is not set")
    def test_hardware(self):
        with pp.Servo(ball(), f"forcedimension,library={FAKE}", maximum_force=3) as servo:
            wait_for(lambda: servo.state().step > 100 and servo.state().device == 0, "steps")

    def test_refusals(self):
        for device, options, words in (("toaster", {}, "toaster"), ("haply", {"hand": stroke()}, "hand"),
                                       ("simulated", {"maximum_force": -1}, "maximum_force"), ("simulated", {"scale": 0}, "scale")):
            with self.assertRaisesRegex(pp.Error, words):
                pp.Servo(ball(), device, **options)
        with self.assertRaisesRegex(TypeError, "hand.astype"):
            pp.Servo(ball(), hand=stroke().astype(complex))


START = "import sys, palpate as pp; s = pp.Scene(); s.add('ball', pp.synthetic_cloud('sphere')); v = pp.Servo(s)\n"


class Exit(unittest.TestCase):
    """The interpreter ends as the script does, with a servo that runs."""

    def ends(self, script, code=0):
        done = subprocess.run([sys.executable, "-c", START + script], capture_output=True, text=True, timeout=300)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def test_at_the_end(self):
        self.assertEqual(self.ends(""), "")

    def test_in_a_cycle(self):
        self.assertEqual(self.ends("class A: pass\na = A(); a.a, a.v = a, v; sys.a = a; sys.v = v"), "")

    def test_in_a_thread(self):
        self.ends("import threading, time\nthreading.Thread(target=lambda: [v.state() for _ in iter(int, 1)], daemon=True).start()")

    def test_by_an_error(self):
        self.assertIn("ZeroDivisionError", self.ends("1 / 0", 1))

    def test_the_device_is_let_go(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "hand")
            script = ("import time\n"
                      f"v = pp.Servo(s, 'remote:{path}')\n"
                      "print('ready', flush=True)\n"
                      "while v.state().device or not v.state().step: time.sleep(0.01)\n")
            with subprocess.Popen([sys.executable, "-c", START + script], stdout=subprocess.PIPE, text=True) as running:
                self.assertEqual(running.stdout.readline(), "ready\n")
                client = subprocess.run([sys.executable, CLIENT, path, "60"], capture_output=True, text=True)
                self.assertEqual(running.wait(), 0)
            self.assertEqual(client.returncode, 0, client.stderr)
            self.assertLess(int(client.stdout.split()[0]), 30_000, "it was told that the device closes")


main()
