"""What the program palpate does and the library does not: it is called as a program."""

from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
import sysconfig
import tempfile
from typing import Any, NamedTuple

import numpy as np

from . import Error


def program() -> str:
    """Path of the program palpate: the one installed with this module, else the first in PATH."""
    mine = os.path.join(sysconfig.get_path("scripts"), "palpate")
    found = mine if os.access(mine, os.X_OK) else shutil.which("palpate")
    if found is None:
        raise Error("the program palpate is not in PATH; install it: sudo apt install palpate, or sudo cmake --install build/release")
    return found


def demo(*options: str) -> int:
    """Opens the page with a simulated scene, until Ctrl-C. options: of `palpate demo`, such as "two", "--duration", "10"."""
    with subprocess.Popen([program(), "demo", *options]) as running:
        try:
            return running.wait()
        except KeyboardInterrupt:  # it got it, too, and says how it went
            return running.wait()


class Replay(NamedTuple):
    """A recorded run that was done again."""

    exact: bool
    """Are all forces the recorded ones, bit for bit?"""
    hands: list[dict[str, Any]]
    """Of each hand: steps, differing_steps, largest_difference_N, first_step, ..."""
    ticks: list[np.ndarray[Any, Any]]
    """Of each hand: a structured array, as the log of `palpate touch` has it: t, hip_x, ..., fx, fy, fz, ..."""


def replay(path: str | os.PathLike[str]) -> Replay:
    """Does again what `palpate touch --record` wrote, and compares the forces."""
    with tempfile.TemporaryDirectory() as folder:
        report, log = os.path.join(folder, "report.json"), os.path.join(folder, "ticks.csv")
        command = [program(), "replay", os.fspath(path), "--json", report, "--log", log]
        done = subprocess.run(command, capture_output=True, text=True)
        if not os.path.exists(report) or os.path.getsize(report) == 0:
            raise Error(done.stderr.strip() or f"palpate replay ended with {done.returncode}")
        told = json.loads(pathlib.Path(report).read_text())
        logs = sorted(pathlib.Path(folder).glob("ticks*.csv"), key=lambda file: (len(file.name), file.name))
        ticks = [np.atleast_1d(np.genfromtxt(file, delimiter=",", names=True)) for file in logs]
        return Replay(told["exact"], told["hands"], ticks)
