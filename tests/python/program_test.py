"""What is done by the program: demo() and replay()."""

import os
import subprocess
import tempfile
import unittest

import support
from support import np, pp


@unittest.skipUnless(support.PROGRAM, "PALPATE_PROGRAM is not set")
class Program(unittest.TestCase):
    def setUp(self):
        self.path = os.environ["PATH"]
        os.environ["PATH"] = os.path.dirname(support.PROGRAM) + os.pathsep + self.path

    def tearDown(self):
        os.environ["PATH"] = self.path

    def test_replay_gives_the_recorded_forces(self):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([pp.program(), "touch", "synthetic:torus", "--duration", "1", "--simulated-time", "--record",
                            f"{folder}/run.mcap"], check=True, capture_output=True)
            done = pp.replay(f"{folder}/run.mcap")
            self.assertTrue(done.exact)
            self.assertEqual(done.hands[0]["differing_steps"], 0)
            self.assertEqual(len(done.ticks[0]), done.hands[0]["steps"])
            self.assertGreater(np.abs(done.ticks[0]["fz"]).max(), 0)

    def test_what_is_no_recording_is_refused(self):
        with self.assertRaisesRegex(pp.Error, "absent.mcap"):
            pp.replay("absent.mcap")

    def test_demo_runs(self):
        self.assertEqual(pp.demo("scan", "--headless", "--port", "0", "--duration", "1"), 0)

    def test_absent_program_is_told(self):
        os.environ["PATH"] = os.path.join(self.path.split(os.pathsep)[0], "nowhere")
        if os.access(os.path.join(os.path.dirname(os.sys.executable), "palpate"), os.X_OK):
            self.skipTest("palpate is installed beside this Python")
        with self.assertRaisesRegex(pp.Error, "PATH"):
            pp.demo()


support.main()
