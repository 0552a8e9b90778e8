"""The proxy of docs/method.md 3 and 4.1, written from its text in plain Python, on surfaces that rest."""

import math

from surface import dot, length, minus, plus, unit


class Proxy:
    """Follows a hand: step() gives the force on it. `friction`: mu_s, mu_d and b_v."""

    def __init__(self, surface, stiffness=500.0, friction=(0.0, 0.0, 0.0)):
        self.surface, self.wanted = surface, stiffness
        self.friction, self.sliding = friction, False
        self.position = self.hand = self.normal = None
        self.stiffness, self.energy = 0.0, 0.0  # of the spring, N/m, and in its tank, J
        self.trail = []  # what a step did, for drawings

    def inside(self, x):
        return not self.surface.sample(x).value > 0

    def step(self, hand, dt=1e-3):
        self.trail = []
        if self.position is None:
            self.position = self.hand = hand
        if self.normal is None:
            self.follow(hand)
        if self.normal is not None:
            self.hold(hand, dt)
        self.hand = hand
        if self.normal is None:
            return [0.0] * len(hand)
        return [self.stiffness * d for d in minus(self.position, hand)]

    def follow(self, hand):
        """Free space (3.1)."""
        place = self.sweep(self.position, hand)
        if place is None:
            self.position = hand
            return
        self.position, self.normal = place, [0.0] * len(hand)
        stretch = length(minus(place, hand))
        moved = length(minus(hand, self.hand)) + 0.01 * self.surface.sample(place).radius
        self.stiffness, self.energy = self.wanted * min(1, moved / stretch if stretch else 1), 0.0

    def sweep(self, start, end):
        """The last free place before the first solid one on the way; None: all is free (3.1)."""
        way = minus(end, start)
        at = lambda t: plus(start, way, t)
        pending, free_until = [(0.0, 1.0)], 0.0
        while pending:
            first, last = pending.pop()
            half, middle = (last - first) / 2 * length(way), (first + last) / 2
            if self.surface.is_free(at(middle), half):
                self.trail.append(("free ball", at(middle), half))
                free_until = last
                continue
            if half >= self.surface.smallest / 16:
                pending += [(middle, last), (first, middle)]
                continue
            solid = next((t for t in (middle, last) if self.inside(at(t))), None)
            if solid is None:
                free_until = last
                continue
            while (solid - free_until) * length(way) > 1e-3 * self.surface.smallest:
                between = (free_until + solid) / 2
                free_until, solid = (free_until, between) if self.inside(at(between)) else (between, solid)
            self.trail.append(("first contact", at(free_until), 0.0))
            return at(free_until)
        return None

    def onto(self, x):
        """Position, normal and R on the surface near x; None: none is found (3.2)."""
        for count in range(11):
            here = self.surface.sample(x)
            slope = length(here.gradient)
            if slope < 1e-8 or here.weight < 1e-6:
                return None
            normal, distance = unit(here.gradient), here.value / slope
            if abs(distance) < (1e-6 if count < 10 else 1e-4) * here.radius:
                return x, normal, here.radius
            if abs(distance) < 2e-4 * here.radius:
                return plus(x, normal, -distance), normal, here.radius
            most = 0.3 * here.radius
            x = plus(x, normal, -max(-most, min(most, distance)))
        return None

    def hold(self, hand, dt):
        """Along the surface to the place nearest to the hand (3.3), then the spring (3.5)."""
        found = self.onto(self.position)
        last, releases, iteration, slid = None, 0, 0, 0.0
        while found and iteration < 20:
            self.position, self.normal, radius = found
            to_hand = minus(hand, self.position)
            above = dot(to_hand, self.normal)
            if above >= 0:
                place = self.sweep(plus(self.position, self.normal, 0.002 * radius), hand)
                if place is None:
                    self.position, self.normal, self.sliding = hand, None, False
                    return
                releases += 1
                if releases > 3 or length(minus(place, self.position)) < 0.003 * radius:
                    break
                found = self.onto(place)
                continue
            tangent = plus(to_hand, self.normal, -above)
            wanted = length(tangent) - self.held(-above, length(tangent), slid, dt)
            if wanted < self.tolerance(iteration) * radius:
                self.sliding = self.sliding and iteration > 0
                break
            self.sliding = True
            pace = self.pace(last, tangent)
            last = self.position, tangent
            found, done = self.advance(hand, tangent, min(pace * wanted, radius / 4), radius)
            slid += done
            iteration += 1
        self.pull(length(minus(hand, self.position)), dt)

    def held(self, depth, along, slid, dt):
        """How much of the spring's stretch along the surface friction holds (4.1)."""
        static, dynamic, viscous = self.friction
        if along <= (dynamic if self.sliding else static) * depth:
            return along
        rate = viscous / dt
        return min(along, (dynamic * depth * self.stiffness + rate * (slid + along)) / (self.stiffness + rate))

    def tolerance(self, iteration):
        if any(self.friction):
            return 1e-5
        return 1e-4 if iteration == 0 else 1e-3

    def pace(self, last, tangent):
        """The secant step of Barzilai and Borwein, within 0.05 and 4."""
        if last is None:
            return 1.0
        most = 1.0 if any(self.friction) else 4.0
        moved = minus(self.position, last[0])
        fallen = dot(moved, minus(last[1], tangent))
        return most if most * fallen <= dot(moved, moved) else max(0.05, dot(moved, moved) / fallen)

    def advance(self, hand, tangent, trial, radius):
        """The surface after a sub-step that is accepted, and its length; None and 0 where none is."""
        before = dot(d := minus(hand, self.position), d)
        for _ in range(7):
            target = plus(self.position, unit(tangent), trial)
            found = self.onto(target)
            if found:
                place, normal, _ = found
                gained = before - dot(d := minus(hand, place), d) >= 1e-3 * trial * length(tangent)
                if gained and dot(normal, self.normal) > 0.3 and length(minus(place, self.position)) <= radius / 2:
                    self.trail.append(("sub-step", self.position, target, place))
                    return found, trial
            trial /= 2
        return None, 0.0

    def pull(self, stretch, dt):
        """The energy tank of 3.5: stiffness rises only as far as it is paid for."""
        if self.stiffness > self.wanted:
            lower = max(self.wanted, self.stiffness * math.exp(-dt / 0.02))
            self.energy = min(0.02, self.energy + (self.stiffness - lower) * stretch ** 2 / 2)
            self.stiffness = lower
        elif self.stiffness < self.wanted:
            rise = min(self.wanted - self.stiffness, self.wanted * dt / 0.02)
            price = rise * stretch ** 2 / 2
            paid = min(price, self.energy)
            self.stiffness += rise * (paid / price if price > 0 else 1)
            self.energy -= paid
