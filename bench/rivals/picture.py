#!/usr/bin/env python3
"""Draws what compare_bench wrote: picture.py FOLDER IMAGE.png

Left, six rows of noise a: angle of the force across, its error up, a mark a method, hollow where contact was lost for
more than a twentieth of the time. Right, one slide off the edge of a box: force along the top's normal and across it.
"""

import csv
import itertools
import statistics
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D
from matplotlib.transforms import Bbox

ROWS = ["plane slide", "light slide", "sphere slide", "box edge", "thin push", "crease 10 mm"]
SLIDES = ["terrain", "graph", "hexahedra", "mls", "paper-pointset", "ours"]
FAMILIES = {  # colour of a family, and whose it is
    "palpate": ("#c0392b", {"ours", "ours-points", "pointset", "metaball"}),
    "the paper": ("#8e44ad", {"paper-pointset", "paper-metaball"}),
    "triangles": ("#2471a3", {"terrain", "terrain+filter", "shaded", "graph", "graph+filter", "video"}),
    "points": ("#1e8449", {"hexahedra", "mls", "spheres", "ball", "local-ball"}),
}
LOST = 0.05  # share of the time


def colour_of(method):
    return next(colour for colour, members in FAMILIES.values() if method in members)


def medians(path):
    """{row: {method: (normal, force, lost)}} of noise a."""
    found = {}
    with open(path, encoding="utf-8") as file:
        for line in csv.DictReader(file):
            if line["noise"] != "a" or line["row"] not in ROWS:
                continue
            values = [float(line[key]) for key in ("normal_deg", "force_N", "lost")]
            found.setdefault(line["row"], {}).setdefault(line["field"], []).append(values)
    return {row: {method: [statistics.median(column) for column in zip(*frames)] for method, frames in methods.items()}
            for row, methods in found.items()}


def label(axes, marks):
    """Names beside their marks, moved up or down until none lies on another or on a mark."""
    axes.figure.canvas.draw()
    places = [axes.transData.transform((x, y)) for x, y, _ in marks.values()]
    taken = [Bbox.from_bounds(x - 3, y - 3, 6, 6) for x, y in places]
    for method, (x, y, _) in sorted(marks.items(), key=lambda item: item[1][1]):
        for shift, side in itertools.product((0, 7, -7, 14, -14, 21, -21, 28, -28, 35, -35), ("left", "right")):
            text = axes.annotate(method, (x, y), xytext=(5 if side == "left" else -5, shift - 2),
                                 textcoords="offset points", fontsize=6.5, ha=side, color=colour_of(method),
                                 fontweight="bold" if method == "ours" else "normal")
            box = text.get_window_extent()
            if not any(box.overlaps(other) for other in taken):
                taken.append(box)
                break
            text.remove()


def draw_errors(axes, row, marks):
    for method, (x, y, lost) in marks.items():
        axes.plot(x, y, "o", markersize=6 if method == "ours" else 4.5, color=colour_of(method),
                  markerfacecolor="none" if lost > LOST else colour_of(method))
    axes.set(xscale="log", yscale="log", title=row)
    axes.margins(0.22, 0.12)
    axes.grid(True, which="major", linewidth=0.3)


def draw_slides(figure, spec, path):
    traces = {}
    with open(path, encoding="utf-8") as file:
        for line in csv.DictReader(file):
            traces.setdefault(line["method"], []).append([float(line[k]) for k in ("t_s", "normal_N", "tangential_N")])
    shown = [method for method in SLIDES if method in traces]
    grid = spec.subgridspec(len(shown), 1, hspace=0.15)
    truth = list(zip(*traces["truth"]))
    for i, method in enumerate(shown):
        axes = figure.add_subplot(grid[i])
        time, normal, tangential = zip(*traces[method])
        axes.plot(truth[0], truth[1], color="0.6", linewidth=2.5)
        axes.plot(truth[0], truth[2], color="0.6", linewidth=2.5, linestyle=":")
        axes.plot(time, normal, color=colour_of(method), linewidth=1)
        axes.plot(time, tangential, color=colour_of(method), linewidth=1, linestyle=":")
        axes.set_ylim(-0.4, 3.4)
        axes.text(0.02, 0.9, method, transform=axes.transAxes, va="top", fontsize=8, color=colour_of(method))
        axes.tick_params(labelbottom=i + 1 == len(shown), labelsize=7)
        if i == 0:
            axes.set_title("off the edge of a box, N\n(dotted: tangential; grey: truth)", fontsize=9)
    axes.set_xlabel("time, s", fontsize=8)


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    folder, image = sys.argv[1:]
    errors = medians(f"{folder}/scores.csv")
    figure = plt.figure(figsize=(15, 8.5), dpi=100, layout="constrained")
    left, right = figure.add_gridspec(1, 2, width_ratios=[3, 1])
    panels = left.subgridspec(2, 3)
    panels_of = []
    for i, row in enumerate(row for row in ROWS if row in errors):
        axes = figure.add_subplot(panels[i // 3, i % 3])
        draw_errors(axes, row, errors[row])
        panels_of.append((axes, row))
        axes.title.set_size(10)
        axes.tick_params(labelsize=7)
        if i // 3 == 1:
            axes.set_xlabel("angle of the force, degrees RMS", fontsize=8)
        if i % 3 == 0:
            axes.set_ylabel("error of the force, N RMS", fontsize=8)
    draw_slides(figure, right, f"{folder}/edge.csv")
    marks = [Line2D([], [], marker="o", linestyle="", color=colour, label=family)
             for family, (colour, _) in FAMILIES.items()]
    hollow = Line2D([], [], marker="o", linestyle="", color="0.4", markerfacecolor="none", label="loses contact")
    panels_of[0][0].legend(handles=[*marks, hollow], loc="upper left", fontsize=7)
    figure.canvas.draw()
    figure.set_layout_engine("none")  # names are placed where their marks are now
    for axes, row in panels_of:
        label(axes, errors[row])
    figure.savefig(image)


if __name__ == "__main__":
    main()
