#!/usr/bin/env python3
"""Draws the pictures of docs/method.md: draw.py writes docs/images/method-*.svg, draw.py --check compares them with what is there.

Every line is computed by the formulas of the text, in surface.py and proxy.py. No library is needed.
"""

import pathlib
import re
import sys

sys.dont_write_bytecode = True
import contact  # noqa: E402
import fields  # noqa: E402
import streams  # noqa: E402
import tools  # noqa: E402

FOLDER = pathlib.Path(__file__).resolve().parents[2] / "docs" / "images"
LARGEST = 40_000  # bytes of a drawing: it is read on a page beside a dozen others
CLOSE = 0.25  # pixels: another machine's sine may round to the next tenth
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")


def drawings():
    return fields.DRAWINGS | contact.DRAWINGS | streams.DRAWINGS | tools.DRAWINGS


def is_same(there, drawn):
    """Do two drawings differ by rounding alone?"""
    if NUMBER.sub("#", there) != NUMBER.sub("#", drawn):
        return False
    return all(abs(float(a) - float(b)) <= CLOSE for a, b in zip(NUMBER.findall(there), NUMBER.findall(drawn)))


def main():
    wrong = []
    for name, draw in drawings().items():
        path = FOLDER / f"method-{name}.svg"
        drawn = draw().svg()
        if len(drawn) > LARGEST:
            wrong.append(f"{path.name} has {len(drawn)} bytes, more than {LARGEST}")
        if "--check" not in sys.argv:
            path.write_text(drawn, encoding="utf-8")
        elif not path.exists() or not is_same(path.read_text(encoding="utf-8"), drawn):
            wrong.append(f"docs/images/{path.name} is not what scripts/drawings/draw.py draws; run it")
    extra = {path.stem for path in FOLDER.glob("method-*.svg")} - {f"method-{name}" for name in drawings()}
    wrong += [f"docs/images/{stem}.svg is drawn by nothing" for stem in sorted(extra)]
    print("\n".join(wrong) or f"{len(drawings())} drawings")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
