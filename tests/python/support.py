"""What the Python tests share. Exit code 77: skipped, with the reason."""

import os
import pathlib
import sys
import unittest


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(77)


try:
    import numpy as np
    import palpate as pp
except ImportError as missing:
    skip(missing)

DATA = os.environ.get("PALPATE_DATA")
PROGRAM = os.environ.get("PALPATE_PROGRAM")


def data(name):
    """A file of the real data; without it the test is skipped."""
    if not DATA:
        raise unittest.SkipTest("PALPATE_DATA is not set")
    path = pathlib.Path(DATA, name)
    if not path.exists():
        raise unittest.SkipTest(f"{path} is absent")
    return path


def ball(**options):
    scene = pp.Scene()
    scene.add("ball", pp.synthetic_cloud("sphere", spacing=4e-3), **options)
    return scene


def stroke(ticks=2000, radius=0.058):
    """A hand that comes down onto a ball of 6 cm and goes around it, m."""
    angle = np.linspace(0, 3, ticks)
    hand = np.stack([np.sin(angle), np.zeros(ticks), np.cos(angle)], axis=1)
    return hand * np.linspace(0.07, radius, ticks)[:, None]


def main():
    result = unittest.main(exit=False, verbosity=2, argv=[sys.argv[0]]).result
    if not result.wasSuccessful():
        sys.exit(1)
    if result.testsRun == len(result.skipped):
        skip("; ".join(sorted({reason for _, reason in result.skipped})))
