"""A wheel of this build can be installed in a fresh environment whose network is cut, and works there."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import support
from support import pp

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "python"))
import palpate_build  # noqa: E402

CUT = ["unshare", "-rn"]  # no network
TRY = """
import pathlib, sys, numpy as np, palpate as pp
assert pathlib.Path(pp.__file__).is_relative_to(sys.prefix), pp.__file__
assert pp.rollout(pp.Plane(), pp.Proxy(), np.array([[0, 0, -1e-3]])).touching.all()
assert pathlib.Path(pp.program()).is_relative_to(sys.prefix)
assert pp.demo("--help") == 0
assert (pathlib.Path(pp.__file__).parent / "py.typed").exists()
"""


def run(*command, **options):
    environment = {key: value for key, value in os.environ.items() if key not in {"PYTHONPATH", "LD_PRELOAD"}}
    done = subprocess.run(command, capture_output=True, text=True, env=environment, **options)
    if done.returncode:
        raise AssertionError(f"{' '.join(map(str, command))}:\n{done.stdout}{done.stderr}")
    return done.stdout


@unittest.skipUnless(shutil.which("unshare") and not subprocess.run([*CUT, "true"], capture_output=True).returncode,
                     "unshare cannot cut the network here")
@unittest.skipUnless(support.PROGRAM, "PALPATE_PROGRAM is not set")
class Wheel(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.environment = pathlib.Path(self.folder.name, "venv")
        run(sys.executable, "-m", "venv", "--system-site-packages", self.environment)

    def works(self, *installed):
        run(*CUT, self.environment / "bin/pip", "install", "--no-input", *installed)
        run(self.environment / "bin/python", "-c", TRY, cwd=self.folder.name)
        run(self.environment / "bin/pip", "uninstall", "-y", "palpate")

    @unittest.skipIf("LD_PRELOAD" in os.environ, "a module with sanitizers works only where they are preloaded")
    def test_of_this_build(self):
        def installed(staging):
            shutil.copytree(pathlib.Path(pp.__file__).parent, pathlib.Path(staging, "palpate"),
                            ignore=shutil.ignore_patterns("__pycache__"))
            return pathlib.Path(support.PROGRAM)

        palpate_build.installed = installed
        self.works(pathlib.Path(self.folder.name, palpate_build.build_wheel(self.folder.name)))

    @unittest.skipUnless(os.environ.get("PALPATE_PIP"), "PALPATE_PIP is not set: it builds all of palpate, for minutes")
    def test_of_the_sources(self):
        self.works(ROOT)


support.main()
