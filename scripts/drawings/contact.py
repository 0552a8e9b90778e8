"""Drawings of docs/method.md 3, 4 and 8: what the proxy and its force do."""

import math

from fields import arc, made, zero
from picture import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, RED, Panel, Picture
from proxy import Proxy
from surface import minus, plus, unit


def hill():
    points, normals = arc(1.3, 0.36, 2.2)
    return made(points, normals)


def steps():
    picture = Picture(760, 400, "One step of the proxy: sweep to first contact, then sub-steps along the surface")
    surface = hill()
    left = Panel(picture, (70, 40, 290, 290), (-1.7, 0.3), (-0.6, 1.4), "3.1, 3.2: sweep to first contact")
    right = Panel(picture, (450, 40, 290, 290), (-1.0, 0.6), (-1.0, 0.6), "3.3: along the surface, in one step")
    for panel in (left, right):
        panel.axes("x, R", "y, R", (-1, -0.5, 0), (-0.5, 0, 0.5, 1) if panel is left else (-0.5, 0, 0.5))
        panel.lines(zero(surface, panel.x, panel.y), BLUE)
        panel.dots(surface.points, INK, 2.5)
    proxy = Proxy(surface)
    start, hand = (-1.4, 1.1), (-0.3, -0.5)
    proxy.step(start)
    place = proxy.sweep(start, hand)
    for kind, center, reach in (event for event in proxy.trail if event[0] == "free ball"):
        if reach > 0.004:
            left.ring(center, reach, GREEN, 1, fill=GREEN, opacity=0.12)
    left.line([start, hand], GREY, 1, "4 3")
    left.dots([start], INK, 4)
    left.dots([hand], RED, 5)
    left.dots([place], ORANGE, 5)
    left.text(*start, "proxy before", right=8, up=6)
    left.text(*hand, "hand", RED, right=9)
    left.text(*place, "first contact", ORANGE, right=10, up=4)
    left.text(-0.75, 0.9, "free for certain", GREEN, size=12)
    slide(right, Proxy(surface), place, (0.15, -0.75))
    return picture


def slide(panel, proxy, start, hand):
    """The sub-steps from first contact to the place that is nearest to a hand which has moved on."""
    proxy.step(plus(start, (-0.01, 0.05)))
    proxy.step(plus(start, (0.002, -0.01)))
    proxy.step(hand)
    sub_steps = [event for event in proxy.trail if event[0] == "sub-step"]
    for _, before, target, after in sub_steps:
        panel.line([before, target], GREY, 1)
        panel.line([target, after], GREY, 1, "2 2")
        panel.dots([before], ORANGE, 3.5)
    panel.line([hand, proxy.position], RED, 1.5, "5 3")
    panel.dots([hand], RED, 5)
    panel.dots([proxy.position], ORANGE, 5.5)
    panel.text(*hand, "hand", RED, right=9)
    panel.text(*proxy.position, "proxy", ORANGE, right=6, up=9)
    panel.text(*sub_steps[0][1], "before", ORANGE, right=-52, up=4)
    panel.text(0.09, -0.45, "F = K (p - h)", RED, right=4)


def press():
    picture = Picture(760, 330, "A hand dragged through a hill, and the springs that hold it")
    surface = hill()
    left = Panel(picture, (70, 40, 380, 220), (-1.5, 1.5), (-0.9, 0.75), "hand and proxy", equal=True)
    left.axes("x, R", "y, R", (-1, 0, 1), (-0.5, 0, 0.5))
    left.lines(zero(surface, left.x, left.y), BLUE)
    way = [(-1.45 + 2.9 * k / 119, 0.1 - 0.55 * math.sin(math.pi * k / 119)) for k in range(120)]
    proxy = Proxy(surface)
    forces = [(proxy.step(hand), proxy.position) for hand in way]
    left.line(way, RED, 1.5)
    for (_, place), hand in list(zip(forces, way))[::8]:
        left.line([hand, place], ORANGE, 1)
        left.dots([place], ORANGE, 3)
    left.text(-1.42, 0.25, "hand", RED)
    left.text(0.15, 0.13, "proxy", ORANGE)
    right = Panel(picture, (530, 40, 200, 220), (0, 120), (0, 0.6), "force")
    right.axes("step", "|F| / K, R", (0, 60, 120), (0, 0.2, 0.4, 0.6))
    right.line([(k, math.hypot(*force) / 500) for k, (force, _) in enumerate(forces)], ORANGE)
    return picture


def tank():
    picture = Picture(760, 330, "Stiffness that changes goes through an energy tank")
    full = 500.0
    proxy = Proxy(None, full)
    proxy.stiffness = full
    rows = []
    for t in (k * 1e-3 for k in range(400)):
        # Presence falls and comes back. Meanwhile the hand presses deeper, at last it lifts and presses again.
        proxy.wanted = full * (0.2 if 0.05 <= t < 0.2 else 1)
        depth = 4e-3 + 2e-3 * min(1, max(0, (t - 0.12) / 0.05))
        depth *= 1 if t < 0.28 else abs(math.cos(math.pi * (t - 0.28) / 0.12))
        proxy.pull(depth, 1e-3)
        rows.append((t, proxy.wanted, proxy.stiffness, 1e3 * proxy.energy, 1e3 * depth))
    left = Panel(picture, (75, 40, 290, 220), (0, 0.4), (0, 560), "stiffness")
    left.axes("time, s", "K, N/m", (0, 0.1, 0.2, 0.3, 0.4), (0, 100, 278, 500))
    left.line([(row[0], row[1]) for row in rows], GREY, 1.5, "4 3")
    left.line([(row[0], row[2]) for row in rows], BLUE)
    left.legend([("wanted", GREY, "4 3"), ("K", BLUE, "")], right=190, down=180)
    right = Panel(picture, (450, 40, 290, 220), (0, 0.4), (0, 9), "tank and stretch")
    right.axes("time, s", "mJ; mm", (0, 0.1, 0.2, 0.3, 0.4), (0, 2, 4, 6))
    right.line([(row[0], row[4]) for row in rows], ORANGE)
    right.line([(row[0], row[3]) for row in rows], GREEN)
    right.legend([("stretch d, mm", ORANGE, ""), ("energy in the tank, mJ", GREEN, "")], right=60, down=22)
    return picture


def friction():
    picture = Picture(760, 330, "Friction: a cone on the proxy")
    left = Panel(picture, (70, 40, 290, 220), (-4, 9), (-6, 4.5), "the hand below a plane, mm")
    left.axes("along the surface, mm", "depth, mm", (-4, 0, 4, 8), (-4, 0, 4))
    left.area([[(-4, 0), (9, 0), (9, -6), (-4, -6)]], LIGHT)
    left.line([(-4, 0), (9, 0)], BLUE)
    left.area([[(0, 0), (-2, -4), (2, -4)]], GREEN, 0.25)
    left.line([(0, 0), (5.5, -4)], RED, 1.5, "5 3")
    left.line([(3.5, 0), (5.5, -4)], ORANGE, 1.5)
    left.dots([(5.5, -4)], RED, 5)
    left.dots([(0, 0)], INK, 4)
    left.dots([(3.5, 0)], ORANGE, 5)
    left.arrow((0.2, 0.6), (3.3, 0.6))
    left.text(0, 1.2, "slides until L = μ_d N", size=12)
    left.text(-3.6, -5.3, "sticks here: L <= μ_s N", GREEN, size=12)
    left.text(5.5, -5.2, "hand", RED)
    right = Panel(picture, (450, 40, 290, 220), (0, 12), (0, 3), "dragged 12 mm, 4 mm deep")
    right.axes("way of the hand, mm", "force along the surface, N", (0, 4, 8, 12), (0, 1, 2))
    for words, static, dynamic, viscous, color, dash in (("μ_s = 0.8, μ_d = 0.5", 0.8, 0.5, 0.0, BLUE, ""), ("μ = 0.5", 0.5, 0.5, 0.0, GREEN, "5 3"),
                                                         ("μ = 0.5, b_v = 5 N s/m at 0.1 m/s", 0.5, 0.5, 5.0, ORANGE, "")):
        right.line(drag(static, dynamic, viscous), color, 2, dash)
        right.legend([(words, color, dash)], right=12, down={BLUE: 20, GREEN: 38, ORANGE: 56}[color])
    return picture


def drag(static, dynamic, viscous, stiffness=500.0, depth=4.0, speed=0.1, dt=1e-3):
    """(way of the hand, tangential force) by 4.1; mm and N."""
    proxy, sliding, found = 0.0, False, []
    rate = viscous / dt
    for k in range(121):
        hand = 1e3 * speed * dt * k
        along = hand - proxy
        if along <= (dynamic if sliding else static) * depth:
            sliding = False
        else:
            sliding = True
            held = min(along, (dynamic * depth * stiffness + rate * along) / (stiffness + rate))
            proxy += along - held
        found.append((hand, stiffness * (hand - proxy) / 1e3))
    return found


def guard():
    picture = Picture(760, 330, "What the guard lets pass")
    left = Panel(picture, (70, 40, 290, 220), (0, 0.1), (0, 4.4), "8.4: a surface rises by 5 mm")
    left.axes("time, s", "force, N", (0, 0.03, 0.06, 0.09), (0, 1, 2, 3, 4))
    wanted, passed, before = [], [], 0.0
    for k in range(101):
        t = k * 1e-3
        hand = 0.03 * min(t, 0.05)  # m deep; it moves at 30 mm/s
        force = 500 * (hand + (5e-3 if t >= 0.03 else 0))
        allowed = 500 * (0.03 * 1e-3 if 0 < t <= 0.05 else 0) + 300 * 1e-3
        before = before + max(-allowed, min(allowed, force - before))
        wanted.append((t, force))
        passed.append((t, before))
    left.line(wanted, GREY, 1.5, "4 3")
    left.line(passed, BLUE)
    left.legend([("wanted", GREY, "4 3"), ("passed, 300 N/s", BLUE, "")], right=140, down=180)
    right = Panel(picture, (450, 40, 290, 220), (0, 4), (0, 3000), "8.1: how stiff a wall may be")
    right.axes("servo step T = delay T_d, ms", "K, N/m", (0, 1, 2, 3, 4), (0, 500, 1000, 2000, 3000))
    for damping, color in ((0.5, ORANGE), (1, GREEN), (2, BLUE)):
        right.line([(1e3 * t, 2 * damping / (3 * t)) for t in (2e-4 + 4e-5 * k for k in range(96))], color)
    right.legend([(f"b + B = {damping} N s/m", color, "") for damping, color in ((2, BLUE), (1, GREEN), (0.5, ORANGE))], right=120, down=30)
    return picture


DRAWINGS = {"proxy": steps, "press": press, "tank": tank, "friction": friction, "guard": guard}
