from __future__ import annotations

from dataclasses import dataclass
from typing import Callable, TypeVar

Config = TypeVar("Config", bound="type[TeleoperatorConfig]")
CHOICES: dict[str, type[TeleoperatorConfig]] = {}


@dataclass
class TeleoperatorConfig:
    id: str | None = None

    @classmethod
    def register_subclass(cls, name: str) -> Callable[[Config], Config]:
        def register(config: Config) -> Config:
            CHOICES[name] = config
            return config

        return register
