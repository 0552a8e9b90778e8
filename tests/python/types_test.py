"""The stubs are those of the module, and the examples are right by them."""

import importlib.util
import os
import pathlib
import subprocess
import sys
import unittest

from support import main, pp, skip

HERE = pathlib.Path(__file__).resolve().parent
EXAMPLES = HERE.parents[1] / "examples" / "python"

if importlib.util.find_spec("mypy") is None:
    skip("mypy is absent (python3-mypy)")


class Types(unittest.TestCase):
    def clean(self, *command):
        package = pathlib.Path(pp.__file__).parent.parent
        path = os.pathsep.join(map(str, (package, HERE / "double", EXAMPLES / "lerobot_teleoperator_palpate")))
        environment = {**os.environ, "MYPYPATH": path, "PYTHONPATH": path, "MYPY_CACHE_DIR": str(package / "mypy")}
        done = subprocess.run([sys.executable, "-m", *command], capture_output=True, text=True, env=environment)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)

    def test_stubs(self):
        self.clean("mypy.stubtest", "palpate", "--allowlist", HERE / "stubtest_allowlist.txt")

    def test_examples(self):
        for target in (["-p", "lerobot_teleoperator_palpate"], sorted(EXAMPLES.glob("*.py"))):
            self.clean("mypy", "--strict", "--scripts-are-modules", *target)


main()
