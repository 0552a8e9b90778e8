"""Clouds whose points lie anywhere: holes between points and their bridges, written from the text of docs/method.md 5.4 in plain
Python, but for the last limit, which acts where surfaces come near each other."""

import math

from faces import Fit, axes_across
from surface import Surface, agree, dot, length, minus, plus, spacings, support_radii, weight_sums

DIRECTIONS = [(math.cos(k * math.pi / 12), math.sin(k * math.pi / 12)) for k in range(24)]


def cut(cell, other):
    """What of a convex polygon around 0 is nearer to 0 than to the other."""
    beyond = [dot(other, corner) - dot(other, other) / 2 for corner in cell]
    kept = []
    for k, corner in enumerate(cell):
        before, here = beyond[k - 1], beyond[k]
        if (before <= 0) != (here <= 0):
            kept.append(plus(cell[k - 1], minus(corner, cell[k - 1]), before / (before - here)))
        if here <= 0:
            kept.append(corner)
    return kept


def is_surrounded(middle, others):
    """Do points lie around an empty disc: no angle of 2.6 rad without any?"""
    around = [minus(o, middle) for o in others if length(minus(o, middle)) <= 1.25 * length(middle)]
    angles = sorted(math.atan2(y, x) for x, y in [[-c for c in middle]] + around)
    return max(b - a for a, b in zip(angles, angles[1:] + [angles[0] + 2 * math.pi])) < 2.6


def hole_beside(i, points, normal, least, widest):
    """The radius of the widest empty disc in the plane of a point that has it on its rim; 0: there is none."""
    axes = axes_across(normal)
    others, near = [], []
    for p in points:
        way = minus(p, points[i])
        along = [dot(axis, way) for axis in axes]
        if 0 < dot(way, way) <= 2 * dot(along, along) and length(way) <= 2.25 * widest:
            others.append(along)
            near += [along] if length(way) <= 2 * least else []
    if all(any(2 * least * dot(direction, o) > dot(o, o) for o in near) for direction in DIRECTIONS):
        return 0.0
    cell = [[2 * widest * x, 2 * widest * y] for x, y in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
    for other in others:
        cell = cut(cell, other)
    return max((r for c in cell if least < (r := length(c)) <= widest and is_surrounded(c, others)), default=0.0)


def close_gaps(points, radii, fits):
    """Gives points beside holes the radius and the plane that bridge them."""
    sums, raised = weight_sums(points, radii), list(radii)
    for i, (radius, fit) in enumerate(zip(radii, list(fits))):
        sparse = sums[i] < 2.5
        if not sparse and fit.aside <= 0.07:
            continue
        hole = hole_beside(i, points, fit.normal, 0.55 * radius, (3 if sparse else 0.8) * radius)
        for reach in (2.5 * math.sqrt(2) * hole, 2.5 * hole):
            wide = Fit(points, points[i], reach) if reach > radius else None
            if wide and wide.is_segment(reach):
                raised[i], fits[i] = reach, wide
                break
    return raised


def prepare_anywhere(points, eye):
    """Surface points of a clean cloud of one smooth surface whose points lie anywhere."""
    radii = support_radii(points, spacings(points))
    fits = [Fit(points, p, 1.15 * radius) for p, radius in zip(points, radii)]
    radii = close_gaps(points, radii, fits)
    normals = agree(points, [fit.normal for fit in fits], radii, eye)
    return Surface(points, normals, radii, confidences=[fit.confidence for fit in fits])
