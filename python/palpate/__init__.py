"""palpate: feel a point cloud. Arrays in, forces out; docs/python.md is the user's page."""

from ._palpate import (
    AnyField, Box, Camera, CloudStream, Contact, DepthCamera, Error, Field, Frame, Plane, PointCloud, PrepareReport,
    Prepared, Proxy, Rollout, Scene, Servo, Source, SourceState, Sphere, SurfacePoints, Tool, ToolContact, ToolProxy, Torus, list_cameras, list_devices,
    note_names, open_camera, prepare, read_cloud, rollout, synthetic_cloud, write_cloud,
)
from .plot import plot
from .program import Replay, demo, program, replay
from .tables import table as _table

for _type in (Contact, Frame, PointCloud, PrepareReport, Rollout, SourceState, SurfacePoints):
    _type._repr_html_ = _table  # what notebooks ask for

__version__ = "@PROJECT_VERSION@"
