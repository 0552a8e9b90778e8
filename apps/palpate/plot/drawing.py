"""What the program's pictures have in common: colours, style, and the facts to draw.

Ends with 3 where matplotlib is missing.
"""

import json
import os
import sys

try:
    import matplotlib
    import numpy as np

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
except ImportError as error:
    print(error, file=sys.stderr)
    sys.exit(3)

INK = "#1f2933"
FAINT = "#8492a6"
GRID = "#e4e7eb"


def load_facts(folder):
    """What facts.json in a folder tells."""
    with open(os.path.join(folder, "facts.json"), encoding="utf-8") as file:
        return json.load(file)


def use_style():
    """Fonts, colours and axes of every picture."""
    plt.rcParams.update({"font.size": 10.5, "font.family": "DejaVu Sans", "text.color": INK,
                         "axes.labelcolor": INK, "axes.edgecolor": FAINT, "xtick.color": INK,
                         "ytick.color": INK, "axes.grid": True, "grid.color": GRID,
                         "axes.axisbelow": True, "axes.spines.top": False,
                         "axes.spines.right": False})


def unit_of(extent):
    """A length unit in which `extent` metres is an easy number."""
    if extent < 1:
        return 1e-3, "mm"
    return (1.0, "m") if extent < 5000 else (1e3, "km")


def normalised(v):
    """v with length one; z where it has none."""
    length = np.linalg.norm(v)
    return v / length if length > 1e-12 else np.array([0.0, 0.0, 1.0])


def viewpoint(points, mean):
    """Rows right, up, towards the viewer; and the direction that counts as height.

    mean: where the surface faces, on average; shorter than 0.5 where it faces all ways.
    """
    open_surface = np.linalg.norm(mean) > 0.5
    height = normalised(mean) if open_surface else np.array([0.0, 0.0, 1.0])
    # A camera's cloud has y down and z ahead; axes that nearly fit are easier to read.
    for axis in np.vstack([np.eye(3), -np.eye(3)]):
        if axis @ height > 0.85:
            height = axis
    flat = points - np.outer(points @ height, height)
    flat = flat - flat.mean(axis=0)
    _, _, axes = np.linalg.svd(flat[:: max(1, len(flat) // 4000)], full_matrices=False)
    side = normalised(axes[0] - (axes[0] @ height) * height)
    if side @ np.array([1.0, 0.3, 0.1]) < 0:
        side = -side
    ahead = np.cross(height, side)
    turn, tilt = np.radians(28), np.radians(42 if open_surface else 24)
    across = np.cos(turn) * side + np.sin(turn) * ahead
    back = np.cross(across, height)
    towards = np.cos(tilt) * back + np.sin(tilt) * height
    return np.vstack([across, np.cross(towards, across), towards]), height


def lit(normals, view):
    """How bright points of these normals are, 0 to 1."""
    light = normalised(view[2] + 0.5 * view[1] - 0.5 * view[0])
    known = np.linalg.norm(normals, axis=1) > 0.5
    return 0.45 + 0.55 * np.where(known, np.abs(normals @ light), 0.8)


def dot_area(seen, width, height):
    """Area of a dot, in square points, that closes a cloud in so many points; and the dots' distance."""
    size = np.maximum(np.ptp(seen[:, :2], axis=0), 1e-9)
    cell = 2.5 * np.sqrt(max(size[0] * size[1], 1e-12) / max(len(seen), 1))
    return np.clip((0.62 * cell * min(width / size[0], height / size[1])) ** 2, 1.5, 60), cell


def scale_bar(axes, unit_name):
    """A bar of a round length in the lower left corner."""
    left, right = axes.get_xlim()
    low, high = axes.get_ylim()
    wanted = 0.2 * (right - left)
    decade = 10 ** np.floor(np.log10(wanted))
    size = max(s * decade for s in (1, 2, 5) if s * decade <= wanted)
    x, y = left + 0.03 * (right - left), low + 0.035 * (high - low)
    axes.plot([x, x + size], [y, y], color=INK, linewidth=3, solid_capstyle="butt")
    axes.text(x + size / 2, y + 0.012 * (high - low), f"{size:g} {unit_name}", ha="center",
              va="bottom", color=INK)
