"""The fields of docs/method.md 2 and the preparation of section 5 that clean clouds need, written from their text: any
dimension, every point looked at."""

import math

from dual import Dual, smax, sqrt, step

WMIN = 0.3  # least weight of a surface (2.3)
LEVEL = 0.4  # T' of a metaball (2.2)
OFFSET = 0.4895863  # R, where T is LEVEL


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def plus(a, b, times=1.0):
    return [x + times * y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def length(a):
    return math.sqrt(dot(a, a))


def unit(a):
    size = length(a)
    return [x / size for x in a]


def wyvill(e):
    """w and the slope (dw/dr) / r at e = r^2 (2.1)."""
    if e >= 1:
        return 0.0, 0.0
    return (1 - e) ** 2 * (5 + 4 * (1 - e)) / 9, (-44 + 68 * e - 24 * e * e) / 9


def plane_sum(height):
    """T of Wyvill's kernel (2.1)."""
    e = height * height
    return 1 - 27 / 8 * e * (1 - 11 / 9 * e + 17 / 27 * e * e - 1 / 9 * e * e * e)


class Sample:
    """The field at one position."""

    def __init__(self, value, gradient, weight, radius):
        self.value = value
        self.gradient = gradient
        self.weight = weight
        self.radius = radius


class Surface:
    """Points with normal, radius, density weight and confidence each, and the field they make (2.3 to 2.6)."""

    def __init__(self, points, normals, radii, weights=None, confidences=None, kind="balanced", tool=0.0):
        self.points, self.normals, self.radii = points, normals, radii
        self.weights = weights or density_weights(points, radii)
        self.confidences = confidences or [1.0] * len(points)
        self.kind, self.tool = kind, tool
        self.smallest = max(min(radii), sorted(radii)[len(radii) // 2] / 4)

    def sums(self, x):
        """W, sum w R, V, sum v n . q, and by axis sum v q and sum v n, with their gradients."""
        axes = range(len(x))
        total = [[0.0] * (len(x) + 1) for _ in range(4 + 2 * len(x))]
        for p, n, radius, a, c in zip(self.points, self.normals, self.radii, self.weights, self.confidences):
            q = minus(p, x)
            e = dot(q, q) / radius ** 2
            if e >= 1 or a == 0:
                continue
            w, slope = wyvill(e)
            by_axis = [a * w] + [-a * slope / radius ** 2 * qk for qk in q]
            nq = dot(n, q)
            terms = [1, radius, c, c * nq] + [c * qk for qk in q] + [c * nk for nk in n]
            for row, term in zip(total, terms):
                for k, d in enumerate(by_axis):
                    row[k] += term * d
            for k in axes:  # q and n . q change with x, too
                total[3][1 + k] -= c * a * w * n[k]
                total[4 + k][1 + k] -= c * a * w
        return [Dual(row[0], row[1:]) for row in total]

    def height(self, sums):
        """f_n of 2.4 and 2.6, and R."""
        size = len(sums[0].g)
        radius = sums[1] / sums[0]
        mean, normal = [s / sums[2] for s in sums[4:4 + size]], [s / sums[2] for s in sums[4 + size:]]
        along = sum((n * a for n, a in zip(normal, mean)), Dual(0.0, [0.0] * size))
        square = sum((n * n for n in normal), Dual(0.0, [0.0] * size))
        imls = -sums[3] / sums[2]
        if self.kind == "point-set":
            return -along / sqrt(square), radius
        if self.kind == "IMLS":
            return imls, radius
        hollow = (imls + along) / radius
        filled = 0.2 * radius * step(0.7 - square, 0, 0.7) * step(hollow, 0, 0.01)
        return 0.5 * (imls - along) - filled, radius

    def united(self, plain):
        """W: for one source the plain sum."""
        return plain

    def sample(self, x):
        sums = self.sums(x)
        plain = sums[0]
        if plain.v < 1e-12:
            return Sample(0.35 * self.smallest, [0.0] * len(x), 0.0, self.smallest)
        radius, weight = sums[1] / plain, self.united(plain)
        scale = radius * (0.35 / WMIN)
        out = OFFSET + self.tool / radius
        value = scale * (plane_sum(out if out.v < 0.85 else Dual(0.85, [0.0] * len(x))) - weight)
        trust = step(sums[2] / plain, 0.25, 0.3)
        if self.kind != "metaball" and sums[2].v > 1e-9 * plain.v:
            height, _ = self.height(sums)
            capped = smax(height - self.tool, scale * (WMIN - weight), 0.1 * radius)
            value = trust * capped + (1 - trust) * value
        return Sample(value.v, value.g, weight.v, radius.v)

    def is_free(self, center, reach):
        """Is nothing within the ball solid, for certain (2.10)?"""
        most = 0.0
        for p, radius, a in zip(self.points, self.radii, self.weights):
            near = max(0.0, length(minus(p, center)) - reach)
            most += a * wyvill((near / radius) ** 2)[0]
        level = plane_sum(min(0.85, OFFSET + self.tool / self.smallest))
        return most < (level if self.kind == "metaball" else min(level, WMIN))


def pairs_within(points, radii):
    """Of each point the others within their own supports, itself among them, with their weights."""
    def weight(i, j):
        return wyvill(dot(d := minus(points[i], points[j]), d) / radii[j] ** 2)[0]

    return [[(j, w) for j in range(len(points)) if (w := weight(i, j)) > 0] for i in range(len(points))]


def weight_sums(points, radii):
    """S_i of 2.2."""
    return [sum(w for _, w in row) for row in pairs_within(points, radii)]


def density_weights(points, radii):
    """a_i of 2.2."""
    pairs = pairs_within(points, radii)
    own = [sum(w for _, w in row) for row in pairs]
    return [1 / max(own[i], 0.8 * sum(w * own[j] for j, w in row) / own[i]) for i, row in enumerate(pairs)]


def spacings(points):
    """s_i of 5.1."""
    raw = []
    for p in points:
        nearest = sorted(d for other in points if (d := dot(q := minus(other, p), q)) > 0)[:8]
        raw.append(math.sqrt(6 * sum(nearest) / (8 * 9)))
    result = []
    for i, p in enumerate(points):
        reach = (2.5 * raw[i]) ** 2
        near = [(w, s) for j, s in enumerate(raw)
                if j != i and (w := wyvill(dot(d := minus(points[j], p), d) / reach)[0]) > 0]
        weight, total = sum(w for w, _ in near), sum(w * s for w, s in near)
        mean = (total + raw[i]) / (weight + 1)
        result.append(min(max(0.75 * raw[i], min(1.5 * raw[i], mean)), 2 * total / weight))
    return result


def support_radii(points, spacing):
    """R_i of 5.3 without noise."""
    radii = [2.5 * s for s in spacing]
    limits = [min(r + length(minus(p, q)) / 2 for q, r in zip(points, radii)) for p in points]
    return [limit if limit < 0.8 * radius else radius for limit, radius in zip(limits, radii)]


def eigen(matrix):
    """(value, vector) of a symmetric matrix, the least value first: Jacobi's rotations."""
    size = len(matrix)
    a = [list(row) for row in matrix]
    v = [[float(i == j) for j in range(size)] for i in range(size)]
    for p, q in [(p, q) for _ in range(12) for p in range(size) for q in range(p + 1, size)]:
        if abs(a[p][q]) < 1e-300:
            continue
        angle = 0.5 * math.atan2(2 * a[p][q], a[q][q] - a[p][p])
        c, s = math.cos(angle), math.sin(angle)
        for m in (a, v):
            for row in m:
                row[p], row[q] = c * row[p] - s * row[q], s * row[p] + c * row[q]
        a[p], a[q] = minus([c * x for x in a[p]], [s * x for x in a[q]]), plus([s * x for x in a[p]], a[q], c)
    return sorted((a[k][k], [row[k] for row in v]) for k in range(size))


def normal_and_confidence(points, center, reach):
    """The plane of the points within reach (5.5): its normal, sign arbitrary, and the planarity of three dimensions."""
    near = [p for p in points if length(minus(p, center)) <= reach]
    size = len(center)
    mean = [sum(p[k] for p in near) / len(near) for k in range(size)]
    scatter = [[sum((p[i] - mean[i]) * (p[j] - mean[j]) for p in near) / len(near) for j in range(size)] for i in range(size)]
    found = eigen(scatter)
    if size < 3:
        return found[0][1], 1.0
    low, middle, high = (max(value, 0.0) for value, _ in found)
    line = min(1.0, max(0.0, (middle / high - 0.03) / 0.04))
    volume = min(1.0, max(0.0, (low / middle - 0.4) / 0.2))
    return found[0][1], line * (1 - volume) if len(near) >= 5 else 0.0


def agree(points, normals, radii, eye):
    """Turns normals until neighbours agree, the most parallel first, and the point next to the eye faces it (2.7; signs without refinements, 5.6)."""
    start = min(range(len(points)), key=lambda i: length(minus(points[i], eye)))
    facing = normals[start] if dot(normals[start], minus(eye, points[start])) > 0 else [-x for x in normals[start]]
    turned, waiting = {}, {start: (1.0, facing)}
    while waiting:
        i = max(waiting, key=lambda k: waiting[k][0])
        turned[i] = n = waiting.pop(i)[1]
        for j, p in enumerate(points):
            parallel = dot(n, normals[j])
            if j in turned or length(minus(points[i], p)) > radii[i] or abs(parallel) < waiting.get(j, (0.0,))[0]:
                continue
            waiting[j] = abs(parallel), normals[j] if parallel > 0 else [-x for x in normals[j]]
    return [turned.get(i, n) for i, n in enumerate(normals)]


def prepare(points, eye):
    """Surface points of a clean cloud of one smooth surface (5.1, 5.3, 2.2, 5.5, 5.6), which the eye sees from outside."""
    radii = support_radii(points, spacings(points))
    fits = [normal_and_confidence(points, p, 1.15 * radius) for p, radius in zip(points, radii)]
    normals = agree(points, [n for n, _ in fits], radii, eye)
    return Surface(points, normals, radii, confidences=[c for _, c in fits])
