from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import palpate
from lerobot.teleoperators.config import TeleoperatorConfig
from lerobot.teleoperators.teleoperator import Teleoperator

POSE = ("x", "y", "z", "qx", "qy", "qz", "qw", "gripper")
FORCE = ("force.x", "force.y", "force.z")


@TeleoperatorConfig.register_subclass("palpate")
@dataclass
class PalpateTeleoperatorConfig(TeleoperatorConfig):
    cloud: str = ""  # file of what is touched; empty: nothing is, and the robot's forces alone are felt
    device: str = "simulated"  # of palpate.Servo
    maximum_force: float = 3.0  # N, on the hand
    stiffness: float = 500.0  # N/m
    scale: float = 1.0  # metres of the robot for one of the hand


class PalpateTeleoperator(Teleoperator):
    config_class = PalpateTeleoperatorConfig
    name = "palpate"

    def __init__(self, config: PalpateTeleoperatorConfig) -> None:
        super().__init__(config)
        self.config = config
        self.servo: palpate.Servo | None = None

    @property
    def action_features(self) -> dict[str, type]:
        return {name: float for name in POSE}

    @property
    def feedback_features(self) -> dict[str, type]:
        return {name: float for name in FORCE}

    @property
    def is_connected(self) -> bool:
        return self.servo is not None and self.servo.running

    @property
    def is_calibrated(self) -> bool:
        return True  # devices calibrate themselves

    def calibrate(self) -> None:
        pass

    def configure(self) -> None:
        pass

    def connect(self, calibrate: bool = True) -> None:
        scene = palpate.Scene()
        if self.config.cloud:
            scene.add("cloud", self.config.cloud)
        self.servo = palpate.Servo(scene, self.config.device, maximum_force=self.config.maximum_force,
                                   stiffness=self.config.stiffness, scale=self.config.scale)

    def connected(self) -> palpate.Servo:
        if self.servo is None or not self.servo.running:
            raise ConnectionError(f"{self} is not connected{': ' + self.servo.problem if self.servo else ''}")
        return self.servo

    def get_action(self) -> dict[str, Any]:
        """Where the proxy is (m) and how the tool is held, world frame; the gripper's opening, m."""
        state = self.connected().state()
        return dict(zip(POSE, map(float, (*state.proxy, *state.orientation, state.gripper))))

    def send_feedback(self, feedback: dict[str, Any]) -> None:
        """The robot's force, N, world frame, through the guard; it fades unless the next one comes within 0.1 s."""
        self.connected().add_force([float(feedback.get(name, 0.0)) for name in FORCE])

    def disconnect(self) -> None:
        if self.servo is not None:
            self.servo.stop()
        self.servo = None
