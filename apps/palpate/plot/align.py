"""Draws sources before and after they were aligned: from aslant, and a cut where most points are.

Usage: align.py FOLDER PICTURE. FOLDER holds cloud.f32 (place before and after, normal, source) and
facts.json.
"""

import os
import sys

from drawing import (FAINT, INK, dot_area, lit, load_facts, np, plt, scale_bar, unit_of, use_style,
                     viewpoint)

COLORS = np.array([[0.13, 0.37, 0.66], [0.93, 0.49, 0.12], [0.17, 0.60, 0.31], [0.66, 0.20, 0.45],
                   [0.45, 0.36, 0.74], [0.55, 0.34, 0.20], [0.10, 0.62, 0.66], [0.60, 0.58, 0.10]])


def main(folder, picture):
    facts = load_facts(folder)
    rows = np.fromfile(os.path.join(folder, "cloud.f32"), np.float32).reshape(-1, 10).astype(float)
    middle = np.median(rows[:, 3:6], axis=0)
    reach = 1.5 * np.percentile(np.linalg.norm(rows[:, 3:6] - middle, axis=1), 80)
    rows = rows[np.linalg.norm(rows[:, 3:6] - middle, axis=1) < reach]
    unit, unit_name = unit_of(reach)
    normals, source = rows[:, 6:9], rows[:, 9].astype(int)
    view, _ = viewpoint((rows[:, 3:6] - middle) / unit, normals.mean(axis=0))
    span = np.percentile(np.abs((rows[:, 3:6] - middle) @ view.T / unit), 99)
    thick = max(each["radius_m"] for each in facts["sources"])
    counts, edges = np.histogram((rows[:, 3:6] - middle) @ view[0], np.arange(-reach, reach, 2 * thick))
    cut_at = edges[np.argmax(counts)] + thick
    use_style()
    figure, cells = plt.subplots(2, 2, figsize=(14.4, 11), dpi=130, facecolor="white")
    for column, (title, first) in enumerate((("before", 0), ("after", 3))):
        places = (rows[:, first:first + 3] - middle) @ view.T
        seen = places / unit
        axes = cells[0, column]
        order = np.argsort(seen[:, 2])
        color = COLORS[source % 8] * lit(normals, view)[:, None]
        axes.scatter(seen[order, 0], seen[order, 1], s=dot_area(seen, 460, 380)[0], c=color[order],
                     linewidths=0, rasterized=True)
        axes.set_axis_off()
        axes.set_title(title, loc="left", color=INK, fontsize=15, fontweight="bold")
        cut = np.abs(places[:, 0] - cut_at) < thick
        low = cells[1, column]
        low.scatter(seen[cut, 2], seen[cut, 1], s=4, c=COLORS[source[cut] % 8], linewidths=0)
        low.set_xlabel(f"section, {unit_name}")
        for each in (axes, low):
            each.set(xlim=(-span, span), ylim=(-0.78 * span, 0.78 * span), aspect="equal")
    scale_bar(cells[0, 0], unit_name)
    for index, each in enumerate(facts["sources"]):
        figure.text(0.03 + 0.23 * (index % 4), 0.965 - 0.05 * (index // 4), each["name"], fontsize=13,
                    color=COLORS[index % 8], fontweight="bold")
        figure.text(0.03 + 0.23 * (index % 4), 0.945 - 0.05 * (index // 4), color=FAINT, fontsize=10,
                    s=f"{1e3 * each['before_m']:.2f} mm residual before, {1e3 * each['after_m']:.2f} after")
    figure.subplots_adjust(left=0.05, right=0.98, top=0.88, bottom=0.06, hspace=0.08, wspace=0.08)
    figure.savefig(picture, format="png")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
