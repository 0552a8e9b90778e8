"""Touches a cloud: ten_lines.py [CLOUD]. Without one it is a ball that a formula makes."""

import sys

import numpy as np
import palpate

scene = palpate.Scene()
source = scene.add("cloud", sys.argv[1] if len(sys.argv) > 1 else palpate.synthetic_cloud("sphere"))
points = source.points()
assert points is not None
top = points.points[points.points[:, 2].argmax()]  # m
hand = top + np.linspace(0.02, -0.004, 1000)[:, None] * (0, 0, 1)  # a thousand ticks, 1 ms each
out = palpate.rollout(palpate.Field(scene), palpate.Proxy(stiffness=500), hand)
print(f"{len(points)} points; touched after {out.touching.argmax()} ms; largest force {np.linalg.norm(out.force, axis=1).max():.2f} N")
