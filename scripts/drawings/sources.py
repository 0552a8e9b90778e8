"""Several sources whose surfaces are one: docs/method.md 2.9, written from its text in plain Python."""

from dual import Dual, sqrt, step
from surface import LEVEL, WMIN, Surface, length, minus, plane_sum, prepare, wyvill


class Sources(Surface):
    """The points of several surfaces of one component. `shifted`: heights go over from one source to the other."""

    def __init__(self, parts, shifted=True):
        columns = zip(*((p.points, p.normals, p.radii, p.weights, p.confidences) for p in parts))
        super().__init__(*(sum(column, []) for column in columns))
        self.parts, self.shifted = parts, shifted

    def sample(self, x):
        self.own = [own for own in (part.sums(x) for part in self.parts) if own[2].v > 0]
        return super().sample(x)

    def united(self, plain):
        """W of all sources: agreement makes nothing fatter."""
        fourth = sum((own[0] * own[0] * own[0] * own[0] for own in self.own), Dual(0.0, [0.0] * len(plain.g)))
        return sqrt(sqrt(fourth)) if self.own else plain

    def height(self, sums):
        height, radius = super().height(sums)
        none = Dual(0.0, [0.0] * len(radius.g))
        if not self.shifted:
            return height, radius
        weights = [self.weight(own, radius) for own in self.own]
        shares = [weight / sum(weights, none) for weight in weights]
        heights = [-own[3] / own[2] for own in self.own]
        size = len(radius.g)
        normal = [sum((share * own[4 + size + k] / own[2] for share, own in zip(shares, self.own)), none) for k in range(size)]
        agree = step(sqrt(sum((n * n for n in normal), none)), 0.98, 0.015)
        by_share = sum((share * h for share, h in zip(shares, heights)), none)
        by_weight = sum((own[2] * h / sums[2] for own, h in zip(self.own, heights)), none)
        return height + agree * (by_share - by_weight), radius

    @staticmethod
    def weight(own, radius):
        """c_s: how much of a source's surface there is, and how finely it sees."""
        height = -own[3] / own[2]
        away = (height if height.v > 0 else -height) / radius
        plane = plane_sum(away) if away.v < 1 else Dual(0.0, [0.0] * len(radius.g))
        fine = own[1] / own[0]
        return own[2] / (fine * fine * fine * fine * sqrt(plane * plane + 0.01))

    def is_free(self, center, reach):
        fourth = 0.0
        for part in self.parts:
            most = sum(a * wyvill((max(0.0, length(minus(p, center)) - reach) / radius) ** 2)[0]
                       for p, radius, a in zip(part.points, part.radii, part.weights))
            fourth += most ** 4
        return fourth ** 0.25 < min(LEVEL, WMIN)


def prepare_sources(clouds, eye):
    """Surface points of clean clouds, each of one smooth surface."""
    return Sources([prepare(points, eye) for points in clouds])
