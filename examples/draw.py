"""Draws what an example prints, lines such as "left 12 degrees: 1.50 N": EXAMPLE | python3 examples/draw.py PICTURE"""

import re
import sys

from matplotlib.figure import Figure

QUANTITIES = {"s": "time", "N": "force", "mm": "position", "degrees": "angle"}
curves = {}
for line in sys.stdin:
    found = re.fullmatch(r"(?:(\w+) )?(-?[\d.]+) (\w+): (-?[\d.]+) (\w+)\n", line)
    if found:
        name, x, across, y, up = found.groups()
        curves.setdefault(name, []).append((float(x), float(y)))
if not curves:
    sys.exit("draw.py: no line like '0.312 s: 0.05 N' came in")

figure = Figure(figsize=(8, 3.6), layout="constrained")
axes = figure.add_subplot(xlabel=f"{QUANTITIES.get(across, '')} / {across}", ylabel=f"{QUANTITIES.get(up, '')} / {up}")
for name, points in curves.items():
    axes.plot(*zip(*points), ".", markersize=3, label=name)
axes.grid(alpha=0.3)
axes.margins(y=0.1)
if up == "N":
    axes.set_ylim(bottom=min(0, axes.get_ylim()[0]))
if len(curves) > 1:
    axes.legend(markerscale=3)
figure.savefig(sys.argv[1], dpi=110)
