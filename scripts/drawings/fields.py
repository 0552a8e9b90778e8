"""Drawings of docs/method.md 2: how points become a surface. Lengths are in R unless said."""

import math
import random

from dual import Dual, smax, smin
from faces import Faces
from picture import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PURPLE, RED, Panel, Picture, level_lines
from sources import Sources
from surface import Surface, dot, minus, plane_sum, plus, unit, wyvill

COLORS = {"metaball": ORANGE, "point-set": GREEN, "IMLS": PURPLE, "balanced": BLUE}


def arc(radius, spacing, half_angle, noise=0.0, seed=5):
    """Points of an arc around (0, -radius), and the normals of the circle."""
    chance = random.Random(seed)
    count = int(half_angle * radius / spacing)
    angles = [k * spacing / radius for k in range(-count, count + 1)]
    normals = [(math.sin(a), math.cos(a)) for a in angles]
    spread = [radius + noise * (2 * chance.random() - 1) * math.sqrt(3) for _ in angles]
    return [(r * n[0], r * n[1] - radius) for r, n in zip(spread, normals)], normals


def made(points, normals, kind="balanced", radius=1.0, **more):
    return Surface(points, normals, [radius] * len(points), kind=kind, **more)


def zero(surface, x, y, columns=80, rows=64):
    return level_lines(lambda a, b: surface.sample((a, b)).value, x, y, columns, rows)


def kernels():
    picture = Picture(760, 330, "Kernels and the weight over a plane")
    left = Panel(picture, (70, 40, 280, 230), (0, 1), (0, 1.05), "weight of a point")
    left.axes("distance, R", "w", (0, 0.25, 0.5, 0.75, 1), (0, 0.5, 1))
    grid = [k / 60 for k in range(61)]
    left.line([(r, wyvill(r * r)[0]) for r in grid], BLUE)
    left.line([(r, (1 - r) ** 4 * (4 * r + 1)) for r in grid], ORANGE, dash="6 4")
    left.legend([("Wyvill (1): default", BLUE, ""), ("Wendland (2)", ORANGE, "6 4")], right=118)
    right = Panel(picture, (450, 40, 280, 230), (0, 1), (0, 1.05), "sum over a plane, T(height)")
    right.axes("height above the plane, R", "T", (0, 0.25, 0.5, 0.75, 1), (0, 0.3, 0.4, 1))
    for level, place, words in ((0.4, 0.44, "T': metaball"), (0.3, 0.31, "Wmin: end of a surface")):
        right.line([(0, level), (1, level)], GREY, 1, "3 3")
        right.text(0.995, place, words, GREY, "end", size=11)
    right.line([(h, plane_sum(h)) for h in grid], BLUE)
    right.line([(h, (1 - h) ** 5 * (14 - 21 * (1 - h) + 8 * (1 - h) ** 2)) for h in grid], ORANGE, dash="6 4")
    right.line([(0.49, 0), (0.49, 0.4)], BLUE, 1, "3 3")
    right.text(0.49, 0.03, "0.49", BLUE, right=4, size=12)
    return picture


def four_fields():
    picture = Picture(760, 400, "The surfaces of four fields over the same noisy points, and their errors on circles")
    x, y = (-1.25, 1.25), (-1.5, 1.0)
    left = Panel(picture, (70, 40, 300, 300), x, y, "one noisy arc, four surfaces")
    left.axes("x, R", "y, R", (-1, 0, 1), (-1, 0, 1))
    points, normals = arc(1.1, 0.36, 2.4, noise=0.03)
    circle = [(1.1 * math.sin(0.05 * k), 1.1 * math.cos(0.05 * k) - 1.1) for k in range(-35, 36)]
    left.line(circle, INK, 1, "2 3")
    for kind in ("metaball", "IMLS", "point-set", "balanced"):
        outer = [line for line in zero(made(points, normals, kind), x, y) if max(b for _, b in line) > -0.2]
        left.lines(outer, COLORS[kind], 2)
    left.dots(points, INK, 2.5)
    left.line([(0.1, 0.78), (1.1, 0.78)], GREY, 1)
    left.text(0.6, 0.78, "R", GREY, up=5)
    left.legend([(kind, color, "") for kind, color in COLORS.items()] + [("true circle", INK, "2 3")], right=85, down=190)
    right = Panel(picture, (450, 40, 280, 300), (1, 6), (-0.09, 0.09), "error on circles without noise")
    right.axes("radius of the circle, R", "height above it, R", (1, 2, 3, 4, 5, 6), (-0.08, -0.04, 0, 0.04, 0.08))
    right.line([(1, 0), (6, 0)], GREY, 1, "3 3")
    radii = [1.0 + 0.1 * k for k in range(51)]
    for kind in ("IMLS", "point-set", "balanced"):
        right.line([(d, height_over(d, kind)) for d in radii], COLORS[kind])
    right.text(1.7, 0.05, "IMLS: bent outward", PURPLE)
    right.text(1.7, -0.055, "point-set: bent inward", GREEN)
    right.text(1.3, 0.006, "balanced: their mean", BLUE)
    return picture


def height_over(radius, kind):
    """Where the surface lies above the top of a finely sampled circle."""
    points, normals = arc(radius, 0.05, min(math.pi, 1.3 / radius))
    surface = made(points, normals, kind, weights=[0.1] * len(points))
    low, high = -0.4, 0.4
    for _ in range(20):
        middle = (low + high) / 2
        height, _ = surface.height(surface.sums((0.0, middle)))
        low, high = (middle, high) if height.v < 0 else (low, middle)
    return middle


def cap():
    picture = Picture(760, 330, "Where a surface ends")
    x, y = (-2.2, 1.8), (-1.2, 1.2)
    points = [(-0.4 * k, 0.0) for k in range(9)]
    surface = made(points, [(0, 1)] * len(points))
    panels = [Panel(picture, (70 + 380 * k, 40, 290, 220), x, y, title, equal=True)
              for k, title in enumerate(("without cap: a plane that pulls", "with cap: solid ends at W = 0.3"))]
    for panel in panels:
        panel.axes("x, R", "height, R", (-2, -1, 0, 1), (-1, 0, 1))
    values = [[surface.sums((a, b)) for a in span(x, 100)] for b in span(panels[0].y, 72)]
    raw = [[max(height_or(surface, s), 0.001 - s[0].v) for s in row] for row in values]
    shade(panels[0], raw, x)
    weight = [[0.3 - s[0].v for s in row] for row in values]
    full = [[surface.sample((a, b)).value for a in span(x, 100)] for b in span(panels[1].y, 72)]
    shade(panels[1], full, x)
    panels[1].lines(level_lines(None, x, panels[1].y, 100, 72, weight), ORANGE, 1.5, "5 3")
    panels[1].text(0.4, 0.5, "W = 0.3", ORANGE)
    for panel in panels:
        panel.dots(points, INK, 3)
        panel.text(-1.9, 0.75, "free, f > 0", GREY)
        panel.text(-1.9, -0.35, "solid", INK)
    panels[0].text(0.1, 0.15, "ends where W is 0", RED, size=12)
    return picture


def span(limits, cells):
    return [limits[0] + (limits[1] - limits[0]) * k / cells for k in range(cells + 1)]


def height_or(surface, sums, beyond=1.0):
    """The height of 2.4; where no point weighs, `beyond`."""
    return surface.height(sums)[0].v if sums[0].v > 1e-9 else beyond


def shade(panel, grid, x, outline=True):
    """Solid places as rows of bars, and the line where the field is 0."""
    rows, columns = len(grid) - 1, len(grid[0]) - 1
    xs, ys = span(x, columns), span(panel.y, rows)
    loops = []
    for j, row in enumerate(grid):
        begin = None
        for i in range(columns + 2):
            solid = i <= columns and row[i] <= 0
            if solid and begin is None:
                begin = i
            elif not solid and begin is not None:
                half = (ys[1] - ys[0]) / 2
                loops.append([(xs[begin], ys[j] - half), (xs[i - 1], ys[j] - half), (xs[i - 1], ys[j] + half), (xs[begin], ys[j] + half)])
                begin = None
    panel.area(loops, LIGHT)
    if outline:
        panel.lines(level_lines(None, x, panel.y, columns, rows, grid), BLUE)


def corner():
    """Points of two faces that meet at a right angle, and the normals: convex seen from above."""
    across = [(-0.2 - 0.4 * k, 0.0) for k in range(6)]
    down = [(0.0, -0.2 - 0.4 * k) for k in range(6)]
    return across, down


def edges():
    picture = Picture(760, 400, "A right-angled edge and crease, three ways")
    x, y = (-0.95, 0.45), (-0.95, 0.45)
    across, down = corner()
    panels = [Panel(picture, (70 + 380 * k, 40, 290, 290), x, y, title, equal=True)
              for k, title in enumerate(("edge: the larger height (smax)", "crease: the smaller height (smin)"))]
    for panel, sign in zip(panels, (1, -1)):
        panel.axes("x, R", "y, R", (-0.8, -0.4, 0, 0.4), (-0.8, -0.4, 0, 0.4))
        for name, height, color, width in ways(across, down, sign):
            grid = [[height((a, b)) for a in span(x, 88)] for b in span(panel.y, 88)]
            panel.lines(level_lines(None, x, panel.y, 88, 88, grid), color, width)
        panel.dots(across + down, INK, 3)
        for p, n in [(across[1], (0, 0.2 * sign)), (down[1], (0.2 * sign, 0))]:
            panel.arrow(p, (p[0] + n[0], p[1] + n[1]))
        panel.legend([("one sum: balanced", GREY, ""), ("labels", ORANGE, ""), ("edge planes", BLUE, "")],
                     right=12, down=228 if sign > 0 else 208)
    for panel, outer, inner in zip(panels, ("free", "solid"), ("solid", "free")):
        panel.text(0.2, 0.3, outer)
        panel.text(-0.85, -0.15, inner)
    return picture


def ways(across, down, sign):
    """(name, height(x), colour, width): all points in one sum, a height for each face, and points that know both planes."""
    upward, aside = [(0.0, float(sign))] * len(across), [(float(sign), 0.0)] * len(down)
    both = made(across + down, upward + aside)
    faces = Faces(across + down, upward + aside, both.radii, both.confidences, [False] * len(across) + [True] * len(down), sign > 0)

    def one_sum(x):
        return height_or(both, both.sums(x))

    def labels(x):
        faces.at = x
        return height_or(faces, faces.sums(x))

    def planes(x):
        own, other = Dual(sign * x[1], []), Dual(sign * x[0], [])
        return (smax(own, other, Dual(0.005, [])) if sign > 0 else smin(own, other, Dual(0.05, []))).v

    return [("one sum", one_sum, GREY, 2), ("labels", labels, ORANGE, 2), ("planes", planes, BLUE, 1.5)]


def sides():
    picture = Picture(760, 400, "Signs of normals and labels of smooth segments")
    left = Panel(picture, (70, 40, 290, 290), (-2, 2), (-1.6, 2.4), "signs: what the eye sees faces it")
    left.axes("x, R", "y, R", (-1, 0, 1), (-1, 0, 1, 2))
    around = [(1.4 * math.cos(a), 0.9 * math.sin(a)) for a in (2 * math.pi * k / 24 for k in range(24))]
    watcher = (-0.3, 2.0)
    for p in around:
        n = unit((p[0] / 1.96, p[1] / 0.81))
        left.arrow(p, plus(p, n, 0.28), BLUE)
        if dot(n, minus(watcher, p)) > 0:
            left.line([watcher, p], GREY, 0.7, "2 3")
        else:
            left.line([p, plus(p, n, -0.28)], GREY, 1, "2 2")
    left.dots(around, INK, 3)
    left.dots([watcher], ORANGE, 5)
    left.text(*watcher, "eye: the proxy", ORANGE, right=9)
    left.text(-0.9, 0.05, "the others follow", size=12)
    left.text(-0.9, -0.15, "their neighbours", size=12)
    right = Panel(picture, (450, 40, 290, 290), (-1, 1), (-1.4, 0.6), "labels: a step within one R")
    right.axes("x, R", "y, R", (-1, -0.5, 0, 0.5, 1), (-1, -0.5, 0, 0.5))

    def height(x):
        wall, floor, tread = Dual(x[0], []), Dual(x[1] + 0.9, []), Dual(x[1], [])
        return smax(smin(wall, floor, Dual(0.1, [])), tread, Dual(0.2, [])).v

    shade(right, [[height((a, b)) for a in span(right.x, 80)] for b in span(right.y, 80)], right.x)
    right.dots([(-0.2 - 0.4 * k, 0) for k in range(3)] + [(0, -0.2 - 0.25 * k) for k in range(3)] + [(0.2 + 0.4 * k, -0.9) for k in range(3)], INK, 3)
    for x, y, words, color in ((-0.95, 0.1, "far face: cuts off (smax)", GREEN), (0.06, -0.4, "near face: touched", BLUE), (-0.6, -1.15, "concave neighbour: smin", ORANGE)):
        right.text(x, y, words, color)
    return picture


def sources():
    picture = Picture(760, 330, "Two sources of one surface")
    left = Panel(picture, (70, 40, 290, 220), (-1.6, 1.6), (-0.45, 0.55), "two scans that lie 0.15 R apart")
    left.axes("x, R", "height, R", (-1, 0, 1), (-0.4, -0.2, 0, 0.2, 0.4))
    scans = [[(x0 + spacing * k, y) for k in range(count)] for x0, y, spacing, count in ((-2.6, 0.0, 0.4, 8), (-0.45, 0.15, 0.3, 11))]
    parts = [made(points, [(0.0, 1.0)] * len(points), radius=2.5 * spacing) for points, spacing in zip(scans, (0.4, 0.3))]
    for shifted, color in ((False, GREY), (True, BLUE)):
        lines = zero(Sources(parts, shifted), left.x, left.y)
        left.lines([line for line in lines if max(y for _, y in line) > -0.1], color)
    for points, color in zip(scans, (ORANGE, GREEN)):
        left.dots(points, color, 4)
    left.legend([("all points alike", GREY, ""), ("by source", BLUE, "")], down=180)
    right = Panel(picture, (450, 40, 290, 220), (1, 8), (0.4, 0.9), "a metaball that n cameras see alike")
    right.axes("n", "height of its surface, R", (1, 2, 4, 6, 8), (0.4, 0.5, 0.6, 0.7, 0.8))
    for words, power, color in (("weights added", 1.0, GREY), ("W of 2.9", 0.25, BLUE)):
        right.line([(n, offset(0.4 / n ** power)) for n in (1 + 0.25 * k for k in range(29))], color)
        right.text(4, offset(0.4 / 4 ** power), words, color, up=16)
    return picture


def offset(level):
    """The height at which the weight over a plane is `level`."""
    low, high = 0.0, 1.0
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if plane_sum(middle) > level else (low, middle)
    return low


def eye():
    picture = Picture(760, 330, "A surface that one eye saw holds towards that eye")
    x, y = (-1.8, 1.8), (-1.3, 1.3)
    points = [(0.36 * k, 0.18 * math.cos(0.8 * k)) for k in range(-7, 8)]
    normals = [(0.4 * math.sin(0.8 * k) / math.hypot(1, 0.4 * math.sin(0.8 * k)), 1 / math.hypot(1, 0.4 * math.sin(0.8 * k)))
               for k in range(-7, 8)]
    surface = made(points, normals)
    watcher = (0.9, 1.1)
    titles = ("f <= 0: a skin 0.56 R deep", "and the gradient faces the eye")
    for k, title in enumerate(titles):
        panel = Panel(picture, (70 + 380 * k, 40, 290, 220), x, y, title, equal=True)
        panel.axes("x, R", "y, R", (-1, 0, 1), (-1, 0, 1))
        shade(panel, [[seen(surface, (a, b), watcher if k else None) for a in span(x, 90)] for b in span(panel.y, 120)], x, not k)
        if k:
            panel.lines([line for line in zero(surface, x, panel.y) if line[0][1] > -0.3], BLUE)
        panel.dots(points, INK, 2.5)
        panel.arrow((-1.2, -1.0), (-1.2, -0.15), RED)
        panel.text(-1.12, -0.85, "passes" if k else "is stopped from behind", RED)
        if k:
            panel.dots([watcher], ORANGE, 5)
            panel.text(*watcher, "eye", ORANGE, right=9, up=-4)
    return picture


def seen(surface, x, watcher):
    """Is f or, with an eye, the larger of f and of how far the gradient turns away from it (2.11): at most 0 where it is solid."""
    here = surface.sample(x)
    slope = math.hypot(*here.gradient)
    if watcher is None or slope == 0:
        return here.value
    towards = minus(watcher, x)
    return max(here.value, -0.1 - dot(here.gradient, towards) / slope / math.hypot(*towards))


DRAWINGS = {"kernels": kernels, "fields": four_fields, "cap": cap, "sides": sides, "edges": edges, "sources": sources, "eye": eye}
