"""Two faces that meet: confident points, assigned planes, segments and labels of docs/method.md 2.7, 2.8, 5.5 and 5.6, written
from its text in plain Python."""

import math

from dual import Dual, smax, smin
from surface import Surface, dot, length, minus, normal_and_confidence, plus, spacings, support_radii, unit


class Faces(Surface):
    """Points of two segments, `second` or not, that meet at a convex edge or in a crease."""

    def __init__(self, points, normals, radii, confidences, second, convex):
        super().__init__(points, normals, radii, confidences=confidences)
        self.convex, self.of_face = convex, []
        for face in (False, True):
            of = [i for i, s in enumerate(second) if s == face]
            columns = (points, normals, radii, self.weights, self.confidences)
            self.of_face.append(Surface(*([column[i] for i in of] for column in columns)))

    def sample(self, x):
        self.at = x
        return super().sample(x)

    def height(self, sums):
        """f_n of 2.8: each face has a height of its own."""
        radius = sums[1] / sums[0]
        parts = [(face, own) for face in self.of_face if (own := face.sums(self.at))[2].v > 1e-9 * sums[2].v]
        heights = [face.height(own)[0] for face, own in parts]
        if len(parts) == 1:
            return heights[0], radius
        total = parts[0][1][2] + parts[1][1][2]
        leave = [left(radius, own[2] / total) for _, own in parts]
        if self.convex:
            return smax(heights[0] - leave[0], heights[1] - leave[1], 0.2 * radius), radius
        return smin(heights[0] + leave[0], heights[1] + leave[1], 0.1 * radius), radius


def left(radius, share):
    """How far a label whose share of the weight is small moves out of the way."""
    short = 0.15 / share - 1
    return radius * short * short if short.v > 0 else Dual(0.0, [0.0] * len(share.g))


class Fit:
    """A plane and what it and a quadratic height over it leave, within a reach of a point (5.5); of three dimensions."""

    def __init__(self, points, center, reach):
        near = [d for p in points if length(d := minus(p, center)) <= reach]
        self.normal, self.confidence = normal_and_confidence(points, center, reach)
        heights = [dot(self.normal, d) for d in near]
        mean = sum(heights) / len(near)
        self.residual = math.sqrt(sum((h - mean) ** 2 for h in heights) / (len(near) - 3))
        along, aside = axes_across(self.normal)
        rows = [(1.0, x, y, x * x, x * y, y * y) for x, y in ((dot(along, d) / reach, dot(aside, d) / reach) for d in near)]
        quadric = least_squares(rows, heights)
        squares = sum((h - dot(quadric, row)) ** 2 for h, row in zip(heights, rows))
        self.curvature_residual = math.sqrt(squares / max(1, len(near) - 6))
        self.points, self.off, self.aside = len(near), abs(quadric[0]), length([sum(d[k] for d in near) for k in range(3)]) / len(near) / reach

    def is_segment(self, radius):
        """Is the point on a smooth segment (5.4)?"""
        return self.points >= 10 and self.confidence >= 0.5 and self.curvature_residual <= 0.03 * radius and self.off <= 0.12 * radius

    def is_confident(self, radius):
        return self.confidence >= 0.5 and (self.residual <= 0.05 * radius or self.curvature_residual <= 0.03 * radius)


def axes_across(normal):
    """Two axes of the plane with this normal, the first of them level."""
    x, y, z = normal
    along = unit([-y, x, 0.0] if math.hypot(x, y) > 1e-5 else [0.0, -z, y])
    return along, [normal[k - 2] * along[k - 1] - normal[k - 1] * along[k - 2] for k in range(3)]


def least_squares(rows, values):
    """The coefficients of the rows' terms with the least squares, by Gauss and Jordan."""
    count = len(rows[0])
    a = [[sum(r[i] * r[j] for r in rows) for j in range(count)] + [sum(r[i] * v for r, v in zip(rows, values))] for i in range(count)]
    for i in range(count):
        pivot = max(range(i, count), key=lambda k: abs(a[k][i]))
        a[i], a[pivot] = a[pivot], a[i]
        for k in range(count):
            if k != i:
                a[k] = plus(a[k], a[i], -a[k][i] / a[i][i])
    return [a[i][count] / a[i][i] for i in range(count)]


def assigned(i, points, radii, fits, confident):
    """The confident point whose plane an uncertain one takes (5.6); None: it lies on none."""
    best = None
    for j in (j for j in range(len(points)) if confident[j]):
        way = minus(points[i], points[j])
        off = abs(dot(fits[j].normal, way))
        if length(way) <= 1.6 * radii[i] and off <= max(3 * fits[j].residual, 0.12 * length(way)):
            best = min(best or (math.inf, j), (off + 0.1 * length(way), j))
    return best and best[1]


def segment(start, points, normals, spacing):
    """The points of the smooth segment that holds one of them (5.6): are they, one by one?"""
    found, waiting = {start}, [start]
    while waiting:
        i = waiting.pop()
        for j, p in enumerate(points):
            way = minus(p, points[i])
            if j in found or length(way) > 1.6 * spacing or abs(dot(normals[i], normals[j])) < math.cos(0.28):
                continue
            if max(abs(dot(normals[i], way)), abs(dot(normals[j], way))) <= 0.45 * spacing:
                found.add(j)
                waiting.append(j)
    return [i in found for i in range(len(points))]


def agreement(n, m, way):
    """How far two normals agree on what is outside, one mirrored halfway between both points (2.7)."""
    return dot(n, m) - 2 * dot(n, way) * dot(m, way) / dot(way, way)


def prepare_faces(points, eye):
    """Surface points of a clean cloud of two flat faces, of which the eye sees the one that is nearest to it."""
    spacing = spacings(points)
    radii = support_radii(points, spacing)
    fits = [Fit(points, p, 1.15 * radius) for p, radius in zip(points, radii)]
    confident = [fit.is_confident(radius) for fit, radius in zip(fits, radii)]
    own = [i if confident[i] else assigned(i, points, radii, fits, confident) for i in range(len(points))]
    normals = [fits[j].normal for j in own]
    trusts = [max(fits[i].confidence, fits[j].confidence / 2) for i, j in enumerate(own)]
    nearest = min(range(len(points)), key=lambda i: length(minus(points[i], eye)))
    first = segment(nearest, points, normals, min(spacing))
    up = normals[nearest] if dot(normals[nearest], minus(eye, points[nearest])) > 0 else [-x for x in normals[nearest]]
    other = next(normals[i] for i, here in enumerate(first) if not here)
    pairs = [(i, j) for i in range(len(points)) if first[i] for j in range(len(points))
             if not first[j] and length(minus(points[i], points[j])) <= 1.3 * radii[i]]
    votes = [agreement(up, other, minus(points[j], points[i])) for i, j in pairs]
    aside = other if sum(a * abs(a) for a in votes) > 0 else [-x for x in other]
    convex = sum(dot(up, minus(points[j], points[i])) for i, j in pairs) < 0
    turned = [up if here else aside for here in first]
    turned = [t if abs(dot(t, n)) > 1 - 1e-9 else [math.copysign(1, dot(t, n)) * x for x in n] for t, n in zip(turned, normals)]
    return Faces(points, turned, radii, trusts, [not here for here in first], convex)
