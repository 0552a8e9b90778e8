"""Draws where a cloud is trusted, from aslant and along its shortest side.

Usage: trust.py FOLDER PICTURE. FOLDER holds cloud.f32 (x, y, z from the middle, normal, trust) and
facts.json.
"""

import os
import sys

from drawing import (FAINT, INK, dot_area, lit, load_facts, np, plt, scale_bar, unit_of, use_style,
                     viewpoint)
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap

TRUSTED = 0.5
# Trusted is calm blue, and what is not is warm: at 0.5 the hue changes at once. The page has the same.
TRUST = LinearSegmentedColormap.from_list(
    "trust", [(0, "#a3111a"), (TRUSTED - 1e-6, "#f59a35"), (TRUSTED, "#cfdde8"), (1, "#6c9bbd")])


def draw_points(axes, seen, color, trusted, width, height):
    """Points from far to near, and above them those that are not trusted."""
    dot, _ = dot_area(seen, width, height)
    order = np.lexsort((seen[:, 2], ~trusted))
    axes.scatter(seen[order, 0], seen[order, 1], s=dot, c=color[order], linewidths=0, rasterized=True)
    axes.set_aspect("equal")


def draw_aslant(axes, cloud, normals, color, trusted, unit_name):
    """The cloud as touch's picture shows it."""
    view, _ = viewpoint(cloud, normals.mean(axis=0))
    color = color.copy()
    color[trusted, :3] *= lit(normals, view)[trusted, None]
    draw_points(axes, cloud @ view.T, color, trusted, 480, 420)
    axes.set_axis_off()
    scale_bar(axes, unit_name)


def draw_along(axes, cloud, color, trusted, unit_name):
    """The cloud along its shortest side, as the density map of `palpate info` shows it."""
    depth = int(np.argmin(np.ptp(cloud, axis=0)))
    right, up = [axis for axis in range(3) if axis != depth]
    towards = cloud[:, depth] * (-1 if depth == 1 else 1)
    seen = np.column_stack([cloud[:, right], cloud[:, up], towards])
    draw_points(axes, seen, color, trusted, 420, 420)
    axes.set_title(f"along {'xyz'[depth]}", loc="left", color=INK)
    axes.set_xlabel(f"{'xyz'[right]}, {unit_name}")
    axes.set_ylabel(f"{'xyz'[up]}, {unit_name}")
    axes.ticklabel_format(useOffset=False, style="plain")
    axes.locator_params(axis="x", nbins=5)


def main(folder, picture):
    facts = load_facts(folder)
    rows = np.fromfile(os.path.join(folder, "cloud.f32"), np.float32).reshape(-1, 7).astype(float)
    unit, unit_name = unit_of(np.ptp(rows[:, :3], axis=0).max())
    cloud = (rows[:, :3] + facts["middle"]) / unit
    color, trusted = TRUST(rows[:, 6]), rows[:, 6] >= TRUSTED
    use_style()
    figure = plt.figure(figsize=(14.4, 7.6), dpi=150, facecolor="white")
    cells = figure.add_gridspec(1, 3, width_ratios=[1.1, 1, 0.025], left=0.02, right=0.95, top=0.86,
                                bottom=0.09, wspace=0.2)
    draw_aslant(figure.add_subplot(cells[0]), cloud, rows[:, 3:6], color, trusted, unit_name)
    draw_along(figure.add_subplot(cells[1]), cloud, color, trusted, unit_name)
    bar = figure.colorbar(ScalarMappable(cmap=TRUST), cax=figure.add_subplot(cells[2]), label="trust",
                          ticks=[0, 0.25, TRUSTED, 0.75, 1])
    bar.outline.set_visible(False)
    figure.text(0.02, 0.945, facts["title"], fontsize=17, fontweight="bold", color=INK)
    figure.text(0.02, 0.91, facts["subtitle"], fontsize=11, color=FAINT)
    figure.savefig(picture, format="png")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
