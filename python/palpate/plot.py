"""Pictures of clouds, contacts and forces, with matplotlib where it is installed."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import PointCloud, Rollout, SurfacePoints

_MOST = 20_000  # points that are drawn


def _cloud(axes: Any, cloud: PointCloud | SurfacePoints) -> None:
    points = cloud.points[:: max(1, len(cloud) // _MOST)]
    axes.scatter(*points.T, c=points[:, 2], s=2, linewidths=0)
    axes.set_box_aspect(np.maximum(np.ptp(points, axis=0), 1e-9))
    axes.set(xlabel="x / m", ylabel="y / m", zlabel="z / m")


def _contact(axes: Any, run: Any) -> None:
    touched = np.asarray(run.touching)
    axes.plot(*np.asarray(run.hip).T, lw=1, label="hand")
    axes.plot(*np.asarray(run.proxy)[touched].T, ".", ms=2, label="proxy in contact")
    low, high = np.min(run.hip, axis=0), np.max(run.hip, axis=0)
    (x, y, z), half = (low + high) / 2, max(float(np.max(high - low)) / 2, 1e-9)  # one scale for all axes
    axes.set(xlim=(x - half, x + half), ylim=(y - half, y + half), zlim=(z - half, z + half))
    axes.set(xlabel="x / m", ylabel="y / m", zlabel="z / m")
    axes.legend()


def _force(axes: Any, run: Any) -> None:
    force = np.asarray(run.force)
    for column, name in zip(force.T, "xyz"):
        axes.plot(run.time, column, lw=1, label=f"$F_{name}$")
    axes.plot(run.time, np.linalg.norm(force, axis=1), "k", lw=1, label="|F|")
    axes.set(xlabel="t / s", ylabel="force / N")
    axes.legend()


def plot(what: Any) -> Any:
    """Draws a PointCloud or SurfacePoints, or contact and force of a Rollout or of Servo.ticks(). Returns the figure."""
    try:
        from matplotlib.figure import Figure  # type: ignore[import]
    except ImportError:
        raise ImportError("plot() needs matplotlib: sudo apt install python3-matplotlib") from None
    if isinstance(what, (PointCloud, SurfacePoints)):
        figure = Figure(figsize=(6, 5))
        _cloud(figure.add_subplot(projection="3d"), what)
    elif isinstance(what, Rollout) or hasattr(what, "contact_force"):
        figure = Figure(figsize=(11, 4), layout="constrained")
        _contact(figure.add_subplot(1, 2, 1, projection="3d"), what)
        _force(figure.add_subplot(1, 2, 2), what)
    else:
        raise TypeError(f"cannot draw a {type(what).__name__}; give a cloud, a Rollout or the ticks of a Servo")
    return figure
