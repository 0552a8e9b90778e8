"""Touches what a depth camera sees: depth_camera.py [CAMERA] [SECONDS]. CAMERA is a name of open_camera(); frames of a
driver of your own are pushed in the same way, as arrays."""

import sys
import time

import numpy as np
import palpate

name = sys.argv[1] if len(sys.argv) > 1 else "simulated:desk"
seconds = float(sys.argv[2]) if len(sys.argv) > 2 else 2.0

frames = palpate.open_camera(name)
first = next(frames)
scene = palpate.Scene()
camera = scene.add_camera("desk", K=first.K, size=first.size, distortion=first.distortion)
camera.push(first.depth, pose=first.pose)
seen = camera.points()
if seen is None or len(seen) == 0:
    sys.exit("the first image shows no surface")

middle = seen.points[len(seen) // 2]
above = np.linspace(0.05, -0.005, 1000)[:, None] * np.array([0, 0, 1.0])  # of the hand, m
with palpate.Servo(scene, hand=middle + np.concatenate([above, above[::-1]]), maximum_force=3) as servo:
    end = time.monotonic() + seconds
    while time.monotonic() < end:  # Python feeds the surface; the servo's thread touches it at 1 kHz
        frame = next(frames)
        camera.push(frame.depth, pose=frame.pose)
        time.sleep(1 / 30)  # a simulated camera is as fast as it is asked
    ticks = servo.ticks()
    print(servo, camera.state(), sep="\n")
    print(f"largest force {np.linalg.norm(ticks.force, axis=1).max():.2f} N in {len(ticks)} steps, {servo.dropped} left out")
