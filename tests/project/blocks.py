"""The code in the documents: where it is, what it says, and the desk of files that it is tried on."""

import array
import contextlib
import copy
import dataclasses
import functools
import math
import os
import pathlib
import re
import shlex
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import textwrap

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = {"palpate", "build/release/apps/palpate/palpate"}
# What a run is given so that it is short, opens no browser and disturbs no other; where its --help has it.
SHORT = {"--duration": "0.3", "--jitter": "0.1", "--headless": None, "--port": "0"}
# The answers to what this machine does not have: devices, cameras, a ROS 2 system.
ABSENT = re.compile("cannot be loaded|no answer from|cannot be opened|none was found|no node publishes|no images and no clouds on|"
                    "this build (has no|cannot)")
# A block between two fences: its indentation, its language and its text.
FENCE = re.compile(r"^( *)```([^\n`]*)\n(.*?)^ *```$", re.MULTILINE | re.DOTALL)


@dataclasses.dataclass(frozen=True)
class Block:
    """Code between two fences of a document."""

    path: pathlib.Path
    line: int
    language: str
    text: str

    def __str__(self):
        return f"{self.path.relative_to(ROOT) if self.path.is_relative_to(ROOT) else self.path}:{self.line}"


def documents(root=ROOT):
    """What is written for readers."""
    return [path for part in ("*.md", "docs/**/*.md", "bench/**/*.md") for path in sorted(root.glob(part))]


def blocks(path):
    """A document's blocks of code, without their indentation."""
    text = path.read_text(encoding="utf-8")
    for found in FENCE.finditer(text):
        yield Block(path, text.count("\n", 0, found.start()) + 1, found[2].strip(), textwrap.dedent(found[3]))


def commands(text):
    """The commands of a shell's block, as lists of words; what stands before && or ; by itself."""
    for line in text.replace("\\\n", " ").splitlines():
        lexer = shlex.shlex(line, posix=True, punctuation_chars=";&|()")
        lexer.whitespace_split = True
        command = []
        for word in [*lexer, ";"]:
            if set(word) <= set(";&|()"):
                if command:
                    yield command
                command = []
            else:
                command.append(word)


class Desk:
    """A folder with the files that documents name, in which their commands are run as a reader does."""

    def __init__(self, program, folder):
        self.program = program
        self.helps = {}
        self.folder = pathlib.Path(folder) / "desk"
        self.folder.mkdir()
        rows = [(2e-3 * x, 2e-3 * y, 6e-3 * math.sin(0.21 * x) * math.cos(0.17 * y) + 1e-4 * x)
                for x in range(60) for y in range(60)]
        text = "".join("%.5f %.5f %.5f\n" % row for row in rows)
        for name in ("scan", "bunny", "a", "b", "scans/bench"):
            moved = "".join("%.5f %.5f %.5f\n" % (x + 0.006, y - 0.004, z + 0.005) for x, y, z in rows) if name == "b" else text
            self.write(f"{name}.ply", f"ply\nformat ascii 1.0\nelement vertex {len(rows)}\nproperty float x\n"
                                      f"property float y\nproperty float z\nend_header\n{moved}")
        self.write("scan.pcd", f"VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {len(rows)}\n"
                               f"HEIGHT 1\nPOINTS {len(rows)}\nDATA ascii\n{text}")
        (self.folder / "scan.las").write_bytes(las(rows))
        (self.folder / "room.splat").write_bytes(b"".join(
            struct.pack("<6f8B", *row, 2e-3, 2e-3, 2e-4, 200, 180, 160, 230, 255, 128, 128, 128) for row in rows))
        self.write("hand.csv", "t,hip_x,hip_y,hip_z\n" + "".join(
            f"{1e-3 * k:.3f},0.06,0.06,{0.02 - 1e-4 * k:.4f}\n" for k in range(300)))
        self.write("rough.toml", "".join(f'[[source]]\nfrom = "{name}.ply"\n' for name in "ab"))
        self.write_sequence("FOLDER")
        setups = [block for block in blocks(ROOT / "docs" / "setup.md") if block.language == "toml"]
        self.write("desk.toml", setups[0].text)
        profile = next(block for block in blocks(ROOT / "docs" / "remote_device.md") if block.language == "toml")
        self.write("wrist.toml", profile.text)
        self.run(["palpate", "touch", "camera:simulated", "--simulated-time", "--duration", "0.3", "--record", "run.mcap",
                  "--log", "forces.csv"])
        recording = (self.folder / "run.mcap").read_bytes()
        (self.folder / "cut.mcap").write_bytes(recording[: len(recording) // 2])

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def write_sequence(self, name):
        """Two depth images of a wall 0.8 m away, and what docs/sequences.md says of them."""
        described = next(block for block in blocks(ROOT / "docs" / "sequences.md") if block.language == "json")
        self.write(f"{name}/sequence.json", described.text)
        self.write(f"{name}/trajectory.log", "".join(f"{k} {k} {k + 1}\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n" for k in range(3)))
        (self.folder / name / "depth").mkdir()
        for k in range(3):
            image = array.array("H", (8000 + (7 * u + 3 * v + k) % 5 for v in range(480) for u in range(640)))
            image.byteswap()
            (self.folder / name / "depth" / f"{k}.pgm").write_bytes(b"P5\n640 480\n65535\n" + image.tobytes())

    def copy(self):
        """The same once more, for those who write into it."""
        other = copy.copy(self)
        other.folder = pathlib.Path(tempfile.mkdtemp(dir=self.folder.parent))
        shutil.copytree(self.folder, other.folder, dirs_exist_ok=True)
        return other

    def run(self, words):
        """Runs the program; what runs until Ctrl-C gets that after two seconds. Returns exit code and what it printed."""
        environment = {key: value for key, value in os.environ.items() if key not in {"DISPLAY", "WAYLAND_DISPLAY"}}
        command = [self.program, *map(harmless, words[1:])]
        with camera(words, self.folder), subprocess.Popen([*alone(), *command], cwd=self.folder, stdin=subprocess.DEVNULL, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, env={**environment, "XDG_RUNTIME_DIR": str(self.folder)}) as child:
            try:
                printed, _ = child.communicate(timeout=2 if words[1] == "replay" and "--view" in words else 120)
            except subprocess.TimeoutExpired:
                child.send_signal(signal.SIGINT)
                try:
                    printed, _ = child.communicate(timeout=20)
                except subprocess.TimeoutExpired:
                    child.kill()
                    raise
        return child.returncode, printed

    def options(self, words):
        """Those that --help lists for a command, or for what stands below it (palpate bag info)."""
        command = tuple(words[1:3]) if words[1] in {"bag", "paper"} else tuple(words[1:2])
        if command not in self.helps:
            self.helps[command] = set(re.findall(r"--[\w-]+", self.run(["palpate", *command, "--help"])[1]))
        return self.helps[command]

    def shortened(self, words):
        """The command in little time, with no window."""
        there = self.options(words)
        words = list(words)
        if "--picture" in words and not can_draw():
            at = words.index("--picture")
            del words[at:at + 2]
        paged = "--view" in words or words[1] == "demo"
        for option, value in SHORT.items():
            fits = "--trajectory" not in words if option == "--duration" else paged or option == "--jitter"
            if option in there and fits:
                if option in words:
                    at = words.index(option)
                    del words[at:at + (1 if value is None else 2)]
                words += [option] if value is None else [option, value]
        return words


@contextlib.contextmanager
def camera(words, folder):
    """The example's camera, where a command waits for one: it tries until the socket is there."""
    if "camera:remote" not in words:
        yield
        return
    client = f"{shlex.quote(sys.executable)} {shlex.quote(str(ROOT / 'examples' / 'remote_camera_client.py'))}"
    loop = f"while true; do {client} palpate-camera; sleep 0.2; done"
    with subprocess.Popen(["sh", "-c", loop], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          start_new_session=True) as child:
        try:
            yield
        finally:
            os.killpg(child.pid, signal.SIGKILL)


@functools.cache
def alone():
    """A network that nobody else is in, where one can be had: no robot may hear of a test."""
    words = ["unshare", "-rn", "sh", "-c", 'ip link set lo up && exec "$@"', "sh"]
    try:
        made = subprocess.run([*words, "true"], capture_output=True, check=False).returncode == 0
    except FileNotFoundError:
        made = False
    return words if made else []


def harmless(word):
    """A device that may be attached is not opened: its maker's library is looked for where none is."""
    kind = re.split("[:,]", word)[0]
    if kind in {"forcedimension", "openhaptics"} and "library=" not in word:
        return word + ",library=/absent"
    return word + ",url=ws://127.0.0.1:9" if kind == "haply" and "url=" not in word else word


def can_draw():
    """Is there what draws pictures?"""
    return subprocess.run([sys.executable, "-c", "import matplotlib"], capture_output=True, check=False).returncode == 0


def las(rows):
    """A LAS file, version 1.2, of points in millimetres."""
    head = struct.pack("<4sHH16sBB32s32sHHHIIBHI5I", b"LASF", 0, 0, bytes(16), 1, 2, b"", b"", 1, 2026, 227, 227, 0, 0, 20,
                       len(rows), len(rows), 0, 0, 0, 0)
    bounds = [bound for axis in zip(*rows) for bound in (max(axis), min(axis))]
    points = b"".join(struct.pack("<iiiHBBbBH", *(round(1e3 * x) for x in row), 0, 0, 0, 0, 0, 0) for row in rows)
    return head + struct.pack("<12d", 1e-3, 1e-3, 1e-3, 0, 0, 0, *bounds) + points
