"""Drawings of docs/method.md 5 to 7: clouds, depth images and time."""

import math
import random

from picture import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PURPLE, RED, Panel, Picture
from surface import dot, length, minus, normal_and_confidence, plus, spacings


def radius():
    picture = Picture(760, 400, "Spacing, support radius and plane of a point")
    chance = random.Random(11)
    points = [(i + 0.35 * (2 * chance.random() - 1), j + 0.35 * (2 * chance.random() - 1)) for i in range(-4, 5) for j in range(-4, 5)]
    middle = min(points, key=lambda p: dot(p, p))
    s = spacings(points)[points.index(middle)]
    left = Panel(picture, (70, 40, 290, 290), (-5, 5), (-4.4, 5.6), "5.1, 5.3: spacing and R, from above")
    left.axes("x", "y", (-4, -2, 0, 2, 4), (-4, -2, 0, 2, 4))
    nearest = sorted(points, key=lambda p: length(minus(p, middle)))[1:9]
    left.ring(middle, 2.5 * s, BLUE, 1.5, fill=BLUE, opacity=0.07)
    left.lines([[middle, p] for p in nearest], GREEN, 1)
    left.dots(points, INK, 3)
    left.dots(nearest, GREEN, 4)
    half = s / 2
    left.line([plus(middle, d, half) for d in ((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1))], ORANGE, 2)
    left.text(-4.8, 5.1, f"s = {s:.2f}: side of a point's square", ORANGE, size=12)
    left.text(-4.8, 4.6, "its eight nearest", GREEN, size=12)
    left.text(2.6, 4.6, "R = 2.5 s", BLUE, size=12)
    right = Panel(picture, (450, 40, 290, 290), (-1.6, 1.6), (-1.9, 1.3), "5.5: planes within 1.15 R, from the side")
    right.axes("x, R", "y, R", (-1, 0, 1), (-1, 0, 1))
    side = [(0.2 * k, (0.3 - 0.55 * (0.2 * k) ** 2 if k < 4 else 0.3 - 0.352) + 0.06 * (2 * chance.random() - 1)) for k in range(-8, 9)]
    right.dots(side, INK, 3)
    for p, color in ((side[5], BLUE), (side[11], RED)):
        normal, _ = normal_and_confidence(side, p, 1.15)
        normal = normal if normal[1] > 0 else [-x for x in normal]
        right.ring(p, 1.15, color, 1, "4 3")
        right.line([plus(p, (normal[1], -normal[0]), t) for t in (-0.8, 0.8)], color, 1.5)
        right.arrow(p, plus(p, normal, 0.45), color)
    right.text(-1.5, 1.05, "curved: the plane does, or a quadric", BLUE, size=12)
    right.text(-1.5, -1.8, "two faces: heights are split, or planes are taken", RED, size=11)
    return picture


def scan_line(chance):
    """Inverse depth along a row of blocks, in deviations of the noise: a flat face, a bent one, and one in front."""
    def true(u):
        if u < 45:
            return 0.08 * u
        if u < 80:
            return 3.6 + 0.02 * (u - 45) ** 2 - 0.3 * (u - 45)
        return 24 - 0.1 * (u - 80)

    return [true(u) for u in range(120)], [true(u) + chance.gauss(0, 1) for u in range(120)]


def line_through(us, values):
    mean_u, mean = sum(us) / len(us), sum(values) / len(us)
    slope = sum((u - mean_u) * (v - mean) for u, v in zip(us, values)) / sum((u - mean_u) ** 2 for u in us)
    return mean, mean_u, slope


def is_explained(us, values):
    """Does noise of one deviation explain what a line leaves? Three deviations of chi squared (6.3)."""
    mean, mean_u, slope = line_through(us, values)
    left = sum((v - mean - slope * (u - mean_u)) ** 2 for u, v in zip(us, values))
    free = len(us) - 2
    return left <= free + math.sqrt(18 * free)


def window_at(u, measured, largest=20):
    """The widest of six windows around the block that a line explains; beside an edge, one that is moved away from it."""
    halves = [round(largest * 4 ** (k / 5 - 1)) for k in range(6)]
    best = None
    for half in halves:
        moved = (0,) if best is None or best[1] - best[0] >= 2 * half - 4 else (0, half, -half)
        for by in moved:
            us = range(max(0, u + by - half), min(len(measured), u + by + half + 1))
            near = abs(line_at(us, measured, u) - measured[u]) <= 2 or by == 0
            if is_explained(us, [measured[k] for k in us]) and near and (best is None or len(us) > best[1] - best[0] + 1):
                best = us[0], us[-1]
    return best or (u - 1, u + 1)


def line_at(us, measured, u):
    mean, mean_u, slope = line_through(us, [measured[k] for k in us])
    return mean + slope * (u - mean_u)


def windows():
    picture = Picture(760, 370, "Windows of the depth filter: as wide as noise asks for and shape allows")
    panel = Panel(picture, (70, 40, 660, 260), (0, 119), (-6, 30), "6.3: a row of blocks, and the window of every eighth")
    panel.axes("block u", "inverse depth, deviations", (0, 20, 40, 60, 80, 100), (0, 10, 20, 30))
    true, measured = scan_line(random.Random(4))
    panel.dots(list(enumerate(measured)), GREY, 2)
    for part in (range(80), range(80, 120)):
        panel.line([(u, true[u]) for u in part], INK, 1, "2 3")
    for u in (20, 28, 36, 44, 52, 60, 68, 76, 84, 92, 100, 108):
        first, last = window_at(u, measured)
        color = ORANGE if abs(first + last - 2 * u) > 2 and first > 0 and last < 119 else BLUE
        at = {k: line_at(range(first, last + 1), measured, k) for k in (first, last, u)}
        panel.line([(first, at[first]), (last, at[last])], color, 1, opacity=0.6)
        panel.dots([(u, at[u])], color, 4)
    panel.legend([("window around the block, its line and its answer", BLUE, ""), ("moved away from an edge", ORANGE, ""), ("true", INK, "2 3")])
    return picture


def over_time():
    picture = Picture(760, 330, "The filter over time of one block")
    panel = Panel(picture, (70, 40, 660, 220), (0, 80), (-4, 14), "6.6: measured in each frame, and its mean over 8 frames at most")
    panel.axes("frame", "inverse depth, deviations", (0, 20, 40, 60, 80), (0, 5, 10))
    chance = random.Random(2)
    true = [0 if k < 25 else 8 if k < 50 else 8 - 0.12 * (k - 50) for k in range(81)]
    measured = [t + chance.gauss(0, 1) for t in true]
    mean, frames, answers = measured[0], 1, []
    for k, value in enumerate(measured):
        if k and abs(value - mean) > 5 * math.sqrt(1 + 1 / frames):
            mean, frames = value, 1
        elif k:
            frames = min(8, frames + 1)
            mean += (value - mean) / frames
        answers.append((k, mean))
    panel.dots(list(enumerate(measured)), GREY, 2)
    panel.line(list(enumerate(true)), INK, 1, "2 3")
    panel.line(answers, BLUE, 2.5)
    panel.text(25.5, 3, "more than five deviations off: moved, begins again", ORANGE)
    panel.legend([("measured", GREY, "2 3"), ("filtered", BLUE, "")])
    return picture


def snapshots():
    picture = Picture(760, 330, "Snapshots: surfaces go from A to B in straight lines")
    left = Panel(picture, (70, 40, 290, 220), (0, 0.2), (-1, 13), "7.1: a point of a depth camera")
    left.axes("time, s", "height, mm", (0, 0.05, 0.1, 0.15, 0.2), (0, 4, 8, 12))
    stamps = (0.0, 0.033, 0.07, 0.098, 0.131, 0.185)
    heights = (0.0, 2.0, 4.2, 5.9, 8.0, 11.0)
    at, before = [(0.0, 0.0)], 0.0
    for k, (stamp, height) in enumerate(zip(stamps, heights)):
        following = stamps[k + 1] if k + 1 < len(stamps) else 0.2
        begin, end = stamp + 0.002, stamp + 0.002 + 0.033
        at += [(begin, before)]
        share = min(1.0, (following + 0.002 - begin) / (end - begin))
        before += share * (height - before)
        at += [(min(end, following + 0.002), before)]
    left.line(at + [(0.2, before)], BLUE, 2.5)
    left.dots(list(zip(stamps, heights)), ORANGE, 4)
    left.legend([("what is felt", BLUE, ""), ("frames, when they come", ORANGE, "1 4")])
    right = Panel(picture, (450, 40, 290, 220), (0, 5), (0, 0.62), "7.2: weight of the third cloud, N = 2")
    right.axes("clouds after the first", "C_k", (0, 1, 2, 3, 4, 5), (0, 0.25, 0.5))
    right.line([(0, 0), (2, 0), (2, 0.5), (4, 0.5), (4, 0), (5, 0)], ORANGE, 2, "5 3")
    right.line([(0, 0), (2, 0), (3, 0.5), (4, 0.5), (5, 0)], BLUE)
    right.legend([("average", ORANGE, "5 3"), ("crossfade", BLUE, "")])
    return picture


def fates():
    picture = Picture(760, 480, "What becomes of a point of a depth image")
    times = [0.02 * k for k in range(301)]
    top = Panel(picture, (70, 40, 660, 200), (0, 6), (0.3, 0.95), "7.3: what its block shows")
    top.axes("", "depth, m", range(7), (0.4, 0.6, 0.8))
    shown = [(t, 0.6 if t < 1 else 0.42 if t < 2 else 0.6 if t < 3 else None if t < 4.2 else 0.6 if t < 5 else 0.85) for t in times]
    for part in ([p for p in shown if p[1] is not None and low <= p[0] < high] for low, high in ((0, 1), (1, 2), (2, 3), (4.2, 5), (5, 6.1))):
        top.line(part, INK, 3)
    top.line([(0, 0.6), (5, 0.6)], BLUE, 1, "4 3")
    for t, depth, words in ((0.1, 0.66, "it"), (1.05, 0.36, "nearer: hidden"), (2.1, 0.66, "it"), (3.05, 0.5, "nothing: silent"), (4.3, 0.66, "it"), (5.05, 0.77, "farther: gone")):
        top.text(t, depth, words, size=12)
    low = Panel(picture, (70, 290, 660, 130), (0, 6), (0, 1.15), "7.3, 7.4: the point's presence, which multiplies the stiffness")
    low.axes("time, s", "presence", range(7), (0, 0.5, 1))
    presence, silent, rows = 0.0, 0.0, []
    for t, depth in shown:
        silent = silent + 0.02 if depth is None else 0.0
        rate = {None: -2.0 if silent > 0.3 else 0.0, 0.6: 2.0, 0.42: -1 / 60, 0.85: -10.0}[depth]
        presence = min(1.0, max(0.0, presence + 0.02 * rate))
        rows.append((t, presence))
    low.line(rows, BLUE, 2.5)
    return picture


DRAWINGS = {"radius": radius, "windows": windows, "over-time": over_time, "snapshots": snapshots, "fates": fates}
