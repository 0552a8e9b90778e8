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
