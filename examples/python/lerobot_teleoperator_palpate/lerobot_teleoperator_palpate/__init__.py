"""A haptic device as a teleoperator of LeRobot, which finds packages by the beginning of their names. The action is
where the proxy is, which never enters the surface of the cloud; the feedback is a force on the hand."""

from .palpate_teleoperator import PalpateTeleoperator, PalpateTeleoperatorConfig

__all__ = ["PalpateTeleoperator", "PalpateTeleoperatorConfig"]
