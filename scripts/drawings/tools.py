"""The drawing of docs/method.md 3.7 and of `--tool`: each kind of tool, its samples and its handle."""

import math

from picture import BLUE, GREY, INK, ORANGE, RED, Panel, Picture

VIEW = (0.62, -0.66, 0.42)  # towards who looks, unit; z is up


def across(p):
    """Where a point in mm is seen: to the right and up, mm."""
    x, y, _ = VIEW
    flat = math.hypot(x, y)
    right = (-y / flat, x / flat, 0)
    up = (-x / flat * VIEW[2], -y / flat * VIEW[2], flat)
    return sum(a * b for a, b in zip(p, right)), sum(a * b for a, b in zip(p, up))


def shares(length, spacing):
    """From -1/2 to 1/2 in steps of at most the spacing."""
    count = max(1, math.ceil(length / spacing - 1e-9))
    return [i / count - 0.5 for i in range(count + 1)]


def box(size, spacing, center=(0, 0, 0)):
    """Samples that are seen, and edges."""
    samples, edges = [], []
    for axis in range(3):
        side = 0.5 if VIEW[axis] > 0 else -0.5
        one, other = (axis + 1) % 3, (axis + 2) % 3
        for a in shares(size[one], spacing):
            for b in shares(size[other], spacing):
                share = [0, 0, 0]
                share[axis], share[one], share[other] = side, a, b
                samples.append(tuple(c + s * l for c, s, l in zip(center, share, size)))
        for a in (-0.5, 0.5):
            for b in (-0.5, 0.5):
                ends = []
                for along in (-0.5, 0.5):
                    share = [0, 0, 0]
                    share[axis], share[one], share[other] = along, a, b
                    ends.append(tuple(c + s * l for c, s, l in zip(center, share, size)))
                hidden = (a > 0) != (VIEW[one] > 0) and (b > 0) != (VIEW[other] > 0)
                if not hidden:
                    edges.append(ends)
    return sorted(set(samples)), edges


def cylinder(length, radius, spacing):
    samples, edges = [], []
    for part in shares(length, spacing):
        rings = [radius]
        if part == 0.5:
            steps = math.ceil(radius / spacing)
            rings = [radius * k / steps for k in range(steps + 1)]
        for ring in rings:
            count = max(8, math.ceil(2 * math.pi * ring / spacing)) if ring > 0 else 1
            for i in range(count):
                angle = 2 * math.pi * i / count
                x, y = math.cos(angle), math.sin(angle)
                if part == 0.5 or x * VIEW[0] + y * VIEW[1] >= 0:
                    samples.append((ring * x, ring * y, part * length))
    for part in (-0.5, 0.5):
        turn = [2 * math.pi * i / 60 for i in range(61)]
        loop = [(radius * math.cos(a), radius * math.sin(a), part * length) for a in turn]
        edges += [pair for pair in zip(loop, loop[1:])
                  if part > 0 or pair[0][0] * VIEW[0] + pair[0][1] * VIEW[1] >= 0]
    flat = math.hypot(VIEW[0], VIEW[1])
    for sign in (-1, 1):
        x, y = -VIEW[1] / flat * radius * sign, VIEW[0] / flat * radius * sign
        edges.append(((x, y, -length / 2), (x, y, length / 2)))
    return samples, edges


def balls(panel, centers, radius):
    for center in centers:
        panel.ring(across(center), radius, BLUE, 0.8)
    panel.dots([across(center) for center in centers], BLUE, 1.6)


def bracket(spacing):
    """An L of two plates, 50 x 30 x 40 mm, 8 mm thick, as a file holds it."""
    foot = box((50, 30, 8), spacing, (0, 0, -16))
    wall = box((8, 30, 32), spacing, (-21, 0, 4))
    samples = [p for p in foot[0] if not (p[2] > -13 and p[0] < -17.1)]
    samples += [p for p in wall[0] if p[2] > -12.1]
    edges = [e for e in foot[1] + wall[1] if not (e[0][0] == e[1][0] == -25 and e[0][2] == e[1][2] == -12)]
    return samples, edges


def drawn(panel, samples, edges):
    panel.lines([[across(a), across(b)] for a, b in edges], GREY, 1)
    panel.dots([across(p) for p in samples], BLUE, 1.7)


def handle(panel, words="handle", right=7, up=-4):
    panel.dots([across((0, 0, 0))], RED, 4)
    panel.text(*across((0, 0, 0)), words, RED, right=right, up=up, size=12)


def kinds():
    picture = Picture(760, 520, "The kinds of tools: samples that are seen, and where the handle is")
    places = [(20 + 245 * (i % 3), 40 + 245 * (i // 3), 225, 205) for i in range(6)]
    titles = ("ball:12", "capsule:60x5", "cylinder:50x15", "box:40x60x20", "gripper:8x20x45", "mesh:bracket.stl")
    panels = [Panel(picture, place, (-45, 45), (-41, 41), title) for place, title in zip(places, titles)]
    balls(panels[0], [(0, 0, 0)], 12)
    handle(panels[0], right=36)
    down = [(0, 0, 28 - 60 * i / 22) for i in range(23)]
    balls(panels[1], down, 5)
    panels[1].dots([across((0, 0, 28))], RED, 4)
    panels[1].text(*across((0, 0, 28)), "handle", RED, right=22, up=-4, size=12)
    drawn(panels[2], *cylinder(50, 15, 7))
    drawn(panels[3], *box((40, 60, 20), 7))
    handle(panels[2], "handle", 44)
    handle(panels[3], "handle, in its middle", -112, -72)
    opening = 16
    for side in (-1, 1):
        center = (side * (8 + opening) / 2, 0, 4 - 45 / 2 + 18)
        drawn(panels[4], *box((8, 20, 45), 6, center))
    top = (0, 0, 4 + 18)
    panels[4].dots([across(top)], RED, 4)
    panels[4].text(*across(top), "handle", RED, right=-22, up=30, size=12)
    for side in (-1, 1):
        panels[4].arrow(across((side * 13, -10, -23)), across((side * 25, -10, -23)), ORANGE)
    panels[4].text(*across((26, -10, -23)), "opening", ORANGE, right=-30, up=-18, size=12)
    drawn(panels[5], *bracket(6))
    handle(panels[5], "the file's origin", 8, 20)
    picture.text(20, 508, "Dots: samples, which stay out of what is solid; balls have a radius of their own. Sizes in mm.", INK, size=12)
    return picture


DRAWINGS = {"tools": kinds}
