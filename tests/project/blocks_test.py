"""Every block of code in the documents is compiled, run or read by a test, and these say so.

cpp, c, cmake: lines of a file that is compiled (examples/, tests/project/consumer/). python: a page's blocks are run one
after another. sh: palpate's commands are run; of others, what is the project's has to be there. toml, json: read by the
program. text, or nothing: no code.
"""

import concurrent.futures
import os
import re
import subprocess
import sys
import tempfile
import unittest

from blocks import ABSENT, FENCE, PROGRAMS, ROOT, Block, Desk, blocks, can_draw, commands, documents

PROGRAM = os.environ["PALPATE_PROGRAM"]
QUOTED = {"cpp": [*ROOT.glob("examples/*.cpp")], "c": [*ROOT.glob("examples/*.c")],
          "cmake": [ROOT / "tests" / "project" / "consumer" / "CMakeLists.txt"]}
LANGUAGES = {*QUOTED, "python", "sh", "toml", "json", "text", "html", ""}  # html: web/test/browser/tab.mjs
# What the blocks of a page find when they begin.
BEFORE = {"docs/remote_camera.md": f"""
import os, sys, types
import palpate
sys.path.insert(0, {str(ROOT / "examples")!r})
os.environ["XDG_RUNTIME_DIR"] = os.getcwd()
camera = palpate.open_camera("remote")

class Made:  # stands for each thing of pyrealsense2; the second frame is asked for when the first was taken
    width, height, fx, fy, ppx, ppy = 8, 6, 10.0, 10.0, 3.5, 2.5
    asked = 0
    get_depth_scale = lambda self: 1e-3
    get_timestamp = lambda self: 5.0
    get_data = lambda self: (700).to_bytes(2, "little") * 48
    __getattr__ = lambda self, name: lambda *arguments: self
    def wait_for_frames(self):
        if Made.asked == 1:
            seen = camera.read(timeout=30)
            sys.exit(0 if seen and seen.size == (8, 6) and abs(seen.depth[5, 7] - 0.7) < 1e-6 else repr(seen))
        Made.asked += 1
        return self

sys.modules["pyrealsense2"] = types.SimpleNamespace(pipeline=Made, stream=types.SimpleNamespace(depth=1))
""", "docs/python.md": """
import palpate, numpy as np
T, (fx, fy, cx, cy) = np.eye(4), (500.0, 500.0, 320.0, 240.0)
images = [(np.full((480, 640), 800, np.uint16), k / 30) for k in range(1, 4)]
"""}
# Programs of the system and of makers; their words are not looked at but for files of the project.
OTHERS = {"sudo", "apt", "bash", "cd", "cmake", "cp", "ctest", "export", "git", "groupadd", "ldconfig", "mkdir", "python3", "ssh",
          "systemctl", "tar", "udevadm", "usermod", "./install", "./install_haptic_driver", "TouchDriver_*/bin/Touch_HeadlessSetup",
          ".venv/bin/pip", ".venv/bin/python"}


def quoted(block):
    """Is a block a part of a file that is compiled? Indentation does not count."""
    wanted = [line.strip() for line in block.text.strip().splitlines()]
    for path in QUOTED[block.language]:
        lines = [line.strip() for line in path.read_text(encoding="utf-8").splitlines()]
        if any(lines[at:at + len(wanted)] == wanted for at in range(len(lines))):
            return []
    return [f"{block}: stands in no file that is compiled"]


def unlabelled(block):
    """A drawing, a formula or an output; code has to say what it is."""
    code = re.search(r"^(palpate|sudo|cmake|scripts/\w+|import|#include)\b", block.text, re.MULTILINE)
    return [f"{block}: '{code[0]}' looks like code; say which: ```sh or another"] if code else []


def of_others(block, words):
    """What a command that is not palpate's names of the project."""
    while re.match(r"[A-Z]+=", words[0]):
        words = words[1:]
    example = re.match(r"build/\w+/(examples/\w+)$", words[0])  # run by a test of its own
    if words[0] not in OTHERS and not (ROOT / f"{example[1]}.cpp" if example else ROOT / words[0]).exists():
        yield f"{block}: {words[0]} is not known"
    for word in words:
        if re.match(r"(apps|bench|docs|examples|python|scripts|tests|web)/", word) and not (ROOT / word).exists():
            yield f"{block}: {word} does not exist"
        if "/share/palpate/" in word and not (ROOT / "packaging" / os.path.basename(word)).exists():
            yield f"{block}: {word} is not installed"
    if words[0].startswith("scripts/") and (ROOT / words[0]).exists():
        text = (ROOT / words[0]).read_text(encoding="utf-8")
        yield from (f"{block}: {words[0]} has no {word}" for word in words[1:] if word.startswith("--") and word not in text)
    if "--preset" in words and f'"{words[words.index("--preset") + 1]}"' not in (ROOT / "CMakePresets.json").read_text():
        yield f"{block}: no preset {words[words.index('--preset') + 1]}"
    if words[0] == "cmake":
        yield from (f"{block}: {word}?" for word in words if word.startswith("--") and word not in {"--preset", "--build", "--install", "--target"})
    if words[:3] == ["sudo", "apt", "install"]:
        listed = re.findall(r"^\w+ +(\S+)", (ROOT / "scripts" / "packages.txt").read_text(), re.MULTILINE)
        known = {name for names in listed for name in names.split("|")}
        yield from (f"{block}: scripts/packages.txt has no {word}" for word in words[3:] if "/" not in word and word not in known)


def tried(desk, block, words):
    """Runs a command of palpate. It has to succeed, or to say that what it asks for is not on this machine."""
    if "--output" in words:  # it overwrites nothing
        (desk.folder / words[words.index("--output") + 1]).unlink(missing_ok=True)
    code, printed = desk.run(desk.shortened(words))
    doctor = words[1] == "doctor" and code in {1, 3}  # it found something
    if code != 0 and not doctor and not (code == 1 and ABSENT.search(printed)):
        yield f"{block}: '{' '.join(words)}' ends with {code}: {printed.strip()[-400:]}"


def shell(desk, block):
    """A block's commands, one after another in a folder of their own."""
    desk = desk.copy()
    for words in commands(block.text):
        yield from tried(desk, block, words) if words[0] in PROGRAMS else of_others(block, words)


def setup(desk, block):
    if block.path.name == "remote_device.md":  # a device's profile, which the command below it reads
        return
    desk = desk.copy()
    desk.write("block.toml", block.text)
    yield from tried(desk, block, ["palpate", "touch", "--setup", "block.toml", "--simulated-time", "--duration", "0.3"])


def sequence(desk, block):
    desk = desk.copy()
    desk.write("FOLDER/sequence.json", block.text)
    yield from tried(desk, block, ["palpate", "info", "sequence:FOLDER"])


def page_of_python(desk, page):
    """A page's blocks as one program."""
    if any("matplotlib" in block.text for block in page) and not can_draw():
        return []
    name = page[0].path.relative_to(ROOT).as_posix()
    done = subprocess.run([sys.executable, "-c", BEFORE.get(name, "") + "\n".join(block.text for block in page)],
                          cwd=desk.copy().folder, env={**os.environ, "MPLBACKEND": "Agg"}, capture_output=True, text=True, check=False)
    return [f"{name}: {done.stderr[-600:]}"] if done.returncode else []


def wrong_spans(desk, path):
    """Commands within sentences: commands and options that palpate does not have."""
    text = FENCE.sub("", path.read_text(encoding="utf-8"))
    for span in re.findall(r"`palpate ([a-z][^`]*)`", text):
        words = ["palpate", *span.split()]
        if not re.search(rf"^  {words[1]} ", desk.run(["palpate", "--help"])[1], re.MULTILINE):
            yield f"{path.name}: palpate has no command '{words[1]}'"
            continue
        there = desk.options(words)
        yield from (f"{path.name}: palpate {words[1]} has no {option}"
                    for option in re.findall(r"--[a-z][\w-]*", span) if option not in there)


EVERY = [block for path in documents() for block in blocks(path)]


class Found(unittest.TestCase):
    maxDiff = None

    def of(self, *languages):
        found = [block for block in EVERY if block.language in languages]
        print(f"{len(found)} blocks: {', '.join(language or 'no language' for language in languages)}")
        return found

    def none_of(self, wrong):
        self.assertEqual([], list(wrong))


class Quoted(Found):
    """What a look at the tree can tell."""

    def test_languages_are_known(self):
        self.none_of(f"{block}: '{block.language}' is tried by nobody" for block in EVERY if block.language not in LANGUAGES)

    def test_quotations_are_compiled(self):
        self.none_of(wrong for block in self.of(*QUOTED) for wrong in quoted(block))

    def test_what_says_nothing_is_no_code(self):
        self.none_of(wrong for block in self.of("text", "") for wrong in unlabelled(block))

    def test_broken_blocks_are_found(self):
        def block(language, text):
            return Block(ROOT / "README.md", 1, language, text)
        self.assertTrue(quoted(block("cpp", "int nowhere;")))
        self.assertFalse(quoted(block("cpp", "  palpate::Scene scene;")))
        self.assertTrue(unlabelled(block("", "palpate demo")))
        for line, count in (("scripts/demo.sh --headless", 0), ("scripts/gone.sh", 2), ("build/release/examples/gone | python3 examples/draw.py a.png", 1), ("scripts/test.sh --no-fizz", 1), ("palpatte demo", 1),
                            ("cmake --preset nothing", 1), ("cmake --prset dev", 1), ("sudo apt install nothing-dev", 1),
                            ("sudo cp /usr/share/palpate/gone.rules /etc", 1)):
            found = [wrong for words in commands(line) for wrong in of_others(block("sh", line), words)]
            self.assertEqual(len(found), count, line)


class Tried(Found):
    """What the program and Python have to tell."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.desk = Desk(PROGRAM, folder.name)

    def each(self, trial, found):
        """Four at a time: most of it waits."""
        with concurrent.futures.ThreadPoolExecutor(4) as pool:
            self.none_of(wrong for some in pool.map(lambda block: list(trial(self.desk, block)), found) for wrong in some)

    def test_commands(self):
        self.each(shell, self.of("sh"))

    def test_setups(self):
        self.each(setup, self.of("toml"))

    def test_sequences(self):
        self.each(sequence, self.of("json"))

    def test_commands_in_sentences(self):
        self.each(wrong_spans, documents())

    def test_lines_of_examples_are_drawn(self):
        if not can_draw():
            self.skipTest("matplotlib is absent")
        for lines, code in (("a 1 s: 2.5 N\nb 1 s: 3 N\n", 0), ("a 1 s, 2 N\n", 1)):
            done = subprocess.run([sys.executable, ROOT / "examples" / "draw.py", self.desk.folder / "drawn.png"], input=lines,
                                  text=True, capture_output=True, check=False)
            self.assertEqual(done.returncode, code, done.stderr)
        self.assertGreater((self.desk.folder / "drawn.png").stat().st_size, 5000)

    def test_python(self):
        try:
            import palpate  # noqa: F401
        except ImportError as missing:
            self.skipTest(str(missing))
        found = self.of("python")
        self.each(page_of_python, [[block for block in found if block.path == path] for path in {block.path: 0 for block in found}])

    def test_broken_ones_are_found(self):
        def wrong(trial, language, text):
            return list(trial(self.desk, Block(ROOT / "README.md", 1, language, text)))
        for line, count in (("palpate touch scan.ply", 0), ("palpate touch scan.ply --stifness 3", 1), ("palpate tuch scan.ply", 1),
                            ("palpate touch gone.ply", 1), ("palpate touch scan.ply --device haply,scal=2", 1),
                            ("palpate touch scan.ply --device haply,scale=2", 0), ("palpate touch camera:opennix", 1)):
            self.assertEqual(len(wrong(shell, "sh", line)), count, line)
        self.assertTrue(wrong(setup, "toml", '[[source]]\nfrom = "scan.ply"\nscael = 1\n'))
        self.assertTrue(wrong(sequence, "json", '{"fx": 500, "fy": 500}'))
        path = self.desk.write("sentences.txt", "`palpate touch --nothing` and `palpate nothing`, `palpate bag info --check`")
        self.assertEqual(len(list(wrong_spans(self.desk, path))), 2)


if __name__ == "__main__":
    unittest.main(verbosity=2)
