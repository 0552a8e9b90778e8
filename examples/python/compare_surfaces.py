"""The same stroke over the same points, on each of the surfaces that they can be made: compare_surfaces.py [PICTURE]."""

import sys

import numpy as np
import palpate

cloud = palpate.synthetic_cloud("sphere", spacing=4e-3, noise=5e-4)  # a ball of 6 cm
angle = np.linspace(0, np.pi, 4000)
stroke = 0.057 * np.stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)], axis=1)  # m; 3 mm deep
stroke[0] *= 1.5  # begins outside
runs = {}
for kind in ("balanced", "pointset", "metaball"):
    scene = palpate.Scene()
    scene.add("ball", cloud)
    field = palpate.Field(scene, kind=kind)  # type: ignore[arg-type]
    runs[kind] = run = palpate.rollout(field, palpate.Proxy(stiffness=500), stroke)
    radius = np.linalg.norm(run.proxy[run.touching], axis=1)
    force = np.linalg.norm(run.force[run.touching], axis=1)
    print(f"{kind:9} surface at {1e3 * radius.mean():.2f} mm (true 60), rough by {1e6 * radius.std():.0f} um; "
          f"force {force.mean():.3f} N +- {force.std():.3f} N")
if len(sys.argv) > 1:
    palpate.plot(runs["balanced"]).savefig(sys.argv[1])
