"""Draws a run of palpate: the cloud, the ways of hand and proxy, the force.

Usage: picture.py FOLDER PICTURE. FOLDER holds cloud.f32 (x, y, z, normal, source), whole.f32
(the same of all clouds, thinned; empty where cloud.f32 is the whole), steps.f32 (t, hip, proxy,
force, touching, us) and facts.json.
"""

import os
import sys

from drawing import (FAINT, INK, dot_area, lit, load_facts, normalised, np, plt, scale_bar, unit_of,
                     use_style, viewpoint)
from matplotlib.collections import LineCollection

HAND = "#2b6cb0"
PROXY = "#c53030"
FORCE = "#dd8a00"


def load(folder):
    """The facts, the cloud, the whole of it and the steps that the program left in a folder."""
    columns = {"cloud.f32": 7, "whole.f32": 7, "steps.f32": 12}
    return [load_facts(folder)] + [
        np.fromfile(os.path.join(folder, name), np.float32).reshape(-1, count).astype(float)
        for name, count in columns.items()]


class Run:
    """The steps by name, lengths in the picture's unit."""

    def __init__(self, steps, unit):
        self.t = steps[:, 0]
        self.hip = steps[:, 1:4] / unit
        self.proxy = steps[:, 4:7] / unit
        self.force = steps[:, 7:10]
        self.touching = steps[:, 10] > 0
        self.size = np.linalg.norm(self.force, axis=1)


def hidden(path, points, cell):
    """Which places of a path, in view coordinates, lie well behind the points."""
    lowest = np.minimum(points[:, :2].min(axis=0), path[:, :2].min(axis=0))
    size = (np.maximum(points[:, :2].max(axis=0), path[:, :2].max(axis=0)) - lowest) / cell
    nearest = np.full(np.ceil(size).astype(int) + 1, -np.inf)
    place = ((points[:, :2] - lowest) / cell).astype(int)
    np.maximum.at(nearest, (place[:, 0], place[:, 1]), points[:, 2])
    at = ((path[:, :2] - lowest) / cell).astype(int)
    return path[:, 2] < nearest[at[:, 0], at[:, 1]] - 2 * cell


def draw_path(axes, path, behind, color, width, label):
    """A path, fainter where it is behind the cloud."""
    for mask, alpha, name in ((behind, 0.3, None), (~behind, 0.95, label)):
        places = np.where(mask[:, None], path, np.nan)
        axes.plot(places[:, 0], places[:, 1], color=color, linewidth=width, alpha=alpha, label=name)


def draw_cloud(axes, cloud, normals, look, room):
    """A cloud coloured by height, in so many points of room; returns it as seen, and the dots'
    distance."""
    view, height = look
    seen, order = cloud @ view.T, np.argsort(cloud @ view[2])
    tall = cloud @ height
    low, high = np.percentile(tall, [1, 99])
    color = plt.get_cmap("viridis")(np.clip((tall - low) / max(high - low, 1e-9), 0, 1) * 0.92)
    color[:, :3] = 0.25 + 0.75 * color[:, :3] * lit(normals, view)[:, None]
    dot, cell = dot_area(seen, *room)
    axes.scatter(seen[order, 0], seen[order, 1], s=dot, c=color[order], linewidths=0,
                 rasterized=True)
    axes.set_aspect("equal")
    axes.set_axis_off()
    return seen, cell


def draw_contact(axes, cloud, normals, run, unit_name):
    """The cloud as seen from where it was touched, with paths and forces; returns from where, and
    its frame there."""
    if len(cloud) == 0:
        cloud, normals = run.proxy, np.zeros_like(run.proxy)
    pushes, total = run.force[run.touching].sum(axis=0), run.size[run.touching].sum()
    look = viewpoint(cloud, pushes / max(total, 1e-9))
    view = look[0]
    seen, cell = draw_cloud(axes, cloud, normals, look, (590, 520))
    hip, proxy = run.hip @ view.T, run.proxy @ view.T
    draw_path(axes, hip, hidden(hip, seen, cell), HAND, 1.1, "hand")
    touched = np.where(run.touching[:, None], proxy, np.nan)
    behind = hidden(proxy, seen, cell)
    draw_path(axes, touched, behind, PROXY, 2.0, "proxy, touching")
    axes.autoscale_view()
    draw_arrows(axes, proxy, behind, run, view)
    scale_bar(axes, unit_name)
    axes.figure.legend(loc="upper left", bbox_to_anchor=(0.014, 0.915), frameon=False, ncol=3,
                       handlelength=1.6)
    return look, np.array([seen[:, :2].min(axis=0), seen[:, :2].max(axis=0)])


def draw_whole(axes, whole, normals, look, frame):
    """All clouds, with the frame of what the other view shows of them."""
    seen, _ = draw_cloud(axes, whole, normals, look, (380, 170))
    least = 0.02 * np.ptp(seen[:, :2], axis=0).max()  # else it could not be found
    size = np.maximum(frame[1] - frame[0], least)
    corner = frame.mean(axis=0) - size / 2
    axes.add_patch(plt.Rectangle(corner, *size, fill=False, edgecolor=PROXY, linewidth=1.8))
    axes.set_anchor("W")
    axes.set_title("the whole; framed: the left view", loc="left", color=INK)


def draw_arrows(axes, proxy, behind, run, view):
    """The force on the hand at some steps with touch."""
    touching = np.flatnonzero(run.touching & (run.size > 0.02 * max(run.size.max(), 1e-9)))
    if len(touching) == 0:
        return
    picked = touching[:: max(1, len(touching) // 70)]
    left, right = axes.get_xlim()
    length = 0.09 * (right - left) / run.size.max()
    for some, alpha in ((picked[behind[picked]], 0.25), (picked[~behind[picked]], 1.0)):
        arrows = (run.force @ view.T)[some, :2] * length
        axes.quiver(proxy[some, 0], proxy[some, 1], arrows[:, 0], arrows[:, 1], color=FORCE,
                    angles="xy", scale_units="xy", scale=1, width=0.0028, headwidth=3.5, zorder=5,
                    alpha=alpha)
    axes.plot([], [], color=FORCE, linewidth=2, label=f"force, up to {run.size.max():.2g} N")


def busiest_contact(run):
    """First and last step of the contact that lasted longest."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], run.touching.astype(int), [0]])))
    starts, ends = edges[::2], edges[1::2]
    longest = np.argmax(ends - starts)
    return starts[longest], ends[longest]


def section_plane(run, first, last):
    """Centre, directions along, up and across, and half the width of a cut through a contact."""
    at = first + int(np.argmax(run.size[first:last]))
    deep = np.linalg.norm(run.proxy - run.hip, axis=1)[first:last].max()
    up = normalised(run.force[at])
    moved = run.proxy[first:last] - run.proxy[at]
    moved = moved - np.outer(moved @ up, up)
    _, _, directions = np.linalg.svd(moved - moved.mean(axis=0), full_matrices=False)
    along = normalised(directions[0] - (directions[0] @ up) * up)
    half = max(6 * deep, 0.3 * np.ptp(moved @ along), 1e-9)
    return run.proxy[at], np.stack([along, up, np.cross(up, along)], axis=1), half


def draw_section(axes, cloud, run, unit_name):
    """A cut through the cloud along a piece of the longest contact."""
    axes.set_title("section through the longest contact", loc="left", color=INK)
    if not run.touching.any():
        axes.text(0.5, 0.5, "the hand never touched", ha="center", color=FAINT,
                  transform=axes.transAxes)
        axes.set_axis_off()
        return
    first, last = busiest_contact(run)
    center, directions, half = section_plane(run, first, last)
    points, hip, proxy = ((p - center) @ directions for p in (cloud, run.hip, run.proxy))
    near = (np.abs(points[:, 2]) < 0.06 * half) & (np.abs(points[:, 0]) < 1.1 * half)
    axes.scatter(points[near, 0], points[near, 1], s=7, color=FAINT, linewidths=0, label="points")
    inside = np.zeros(len(hip), bool)
    span = slice(max(first - 150, 0), last + 150)
    inside[span] = np.abs(hip[span, 2]) < 0.5 * half
    touching = inside & run.touching
    axes.plot(np.where(inside, hip[:, 0], np.nan), hip[:, 1], color=HAND, linewidth=1.4,
              label="hand")
    axes.plot(np.where(touching, proxy[:, 0], np.nan), proxy[:, 1], color=PROXY, linewidth=2,
              label="proxy")
    picked = np.flatnonzero(touching)[:: max(1, touching.sum() // 40)]
    springs = np.stack([hip[picked, :2], proxy[picked, :2]], axis=1)
    axes.add_collection(LineCollection(springs, colors=FORCE, linewidths=0.8, alpha=0.8))
    axes.set_aspect("equal")
    axes.set_xlim(-half, half)
    axes.set_ylim(-0.62 * half, 0.62 * half)
    axes.set_xlabel(unit_name)
    axes.legend(loc="upper right", frameon=False, ncol=3, handlelength=1.4)


def draw_force(axes, run):
    """The force over time, with contacts shaded."""
    axes.fill_between(run.t, 0, 1, where=run.touching, transform=axes.get_xaxis_transform(),
                      color="#f1f4f8", linewidth=0)
    axes.fill_between(run.t, 0, run.size, color=FORCE, alpha=0.25, linewidth=0)
    axes.plot(run.t, run.size, color=FORCE, linewidth=1.1)
    axes.set_title("force on the hand", loc="left", color=INK)
    axes.set_xlabel("time, s")
    axes.set_ylabel("N")
    axes.set_xlim(run.t[0], max(run.t[-1], run.t[0] + 1e-3))
    axes.set_ylim(0, 1.15 * max(run.size.max(), 1e-3))
    if run.size.max() > 0:
        top = int(np.argmax(run.size))
        share = (run.t[top] - run.t[0]) / max(run.t[-1] - run.t[0], 1e-9)
        side = "left" if share < 0.06 else "right" if share > 0.94 else "center"
        axes.annotate(f"{run.size[top]:.2f} N", (run.t[top], run.size[top]), xytext=(0, 5),
                      textcoords="offset points", ha=side, color=INK)


def main(folder, picture):
    facts, cloud, whole, steps = load(folder)
    extent = np.ptp(np.vstack([steps[:, 1:4], steps[:, 4:7]]), axis=0).max()
    unit, unit_name = unit_of(extent)
    run = Run(steps, unit)
    use_style()
    figure = plt.figure(figsize=(14.4, 8.6), dpi=150, facecolor="white")
    heights = [1.25, 1] if len(whole) == 0 else [1, 1.1, 1]
    cells = figure.add_gridspec(len(heights), 2, width_ratios=[1.55, 1], height_ratios=heights,
                                left=0.02, right=0.985, top=0.895, bottom=0.07, wspace=0.09,
                                hspace=0.3 if len(whole) == 0 else 0.45)
    seen = draw_contact(figure.add_subplot(cells[:, 0]), cloud[:, :3] / unit, cloud[:, 3:6], run,
                        unit_name)
    if len(whole) > 0:
        draw_whole(figure.add_subplot(cells[0, 1]), whole[:, :3] / unit, whole[:, 3:6], *seen)
    draw_section(figure.add_subplot(cells[-2, 1]), cloud[:, :3] / unit, run, unit_name)
    draw_force(figure.add_subplot(cells[-1, 1]), run)
    figure.text(0.02, 0.955, facts["title"], fontsize=17, fontweight="bold", color=INK)
    figure.text(0.02, 0.925, facts["subtitle"], fontsize=11, color=FAINT)
    figure.savefig(picture, format="png")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
