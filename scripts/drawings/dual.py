"""Numbers that carry their gradient: f(x) and its exact derivative by x in one pass."""

import math


class Dual:
    """A value and its gradient, a list."""

    __slots__ = ("v", "g")

    def __init__(self, value, gradient):
        self.v = value
        self.g = gradient

    def __add__(self, other):
        if isinstance(other, Dual):
            return Dual(self.v + other.v, [a + b for a, b in zip(self.g, other.g)])
        return Dual(self.v + other, self.g)

    def __mul__(self, other):
        if isinstance(other, Dual):
            return Dual(self.v * other.v, [a * other.v + b * self.v for a, b in zip(self.g, other.g)])
        return Dual(self.v * other, [a * other for a in self.g])

    def __neg__(self):
        return self * -1

    def __sub__(self, other):
        return self + -other

    def __rsub__(self, other):
        return -self + other

    def __truediv__(self, other):
        if not isinstance(other, Dual):
            return self * (1 / other)
        ratio = self.v / other.v
        return Dual(ratio, [(a - ratio * b) / other.v for a, b in zip(self.g, other.g)])

    def __rtruediv__(self, other):
        ratio = other / self.v
        return Dual(ratio, [-ratio / self.v * g for g in self.g])

    __radd__ = __add__
    __rmul__ = __mul__


def sqrt(x):
    root = math.sqrt(x.v)
    return Dual(root, [g / (2 * root) for g in x.g])


def step(t, a, d):
    """S(t; a, d) of method 1: rises from 0 at a to 1 at a + d."""
    u = (t - a) / d
    if u.v <= 0 or u.v >= 1:
        return Dual(0.0 if u.v <= 0 else 1.0, [0.0] * len(u.g))
    return u * u * (3 - 2 * u)


def smax(f, g, k):
    """The smooth maximum of method 1."""
    larger, apart = (f, f - g) if f.v > g.v else (g, g - f)
    left = k - apart
    return larger + left * left / (4 * k) if left.v > 0 else larger


def smin(f, g, k):
    return -smax(-f, -g, k)
