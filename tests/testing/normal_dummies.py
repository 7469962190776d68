"""Normal laws with one fault each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from nonsmooth.interfaces import RigidNormalLaw

Certificate = Callable[[float, float, float], bool]


def sound(g: float, f: float, tolerance: float) -> bool:
    return g >= -tolerance and f >= -tolerance and min(abs(g), abs(f)) <= tolerance


def refusing(g: float, f: float, tolerance: float) -> bool:
    return sound(g, f, tolerance) and f <= tolerance


def penetrating(g: float, f: float, tolerance: float) -> bool:
    return f >= -tolerance and min(abs(g), abs(f)) <= tolerance


def pulling(g: float, f: float, tolerance: float) -> bool:
    return g >= -tolerance and min(abs(g), abs(f)) <= tolerance


def far_reaching(g: float, f: float, tolerance: float) -> bool:
    return g >= -tolerance and f >= -tolerance


def absolute(g: float, f: float, tolerance: float) -> bool:
    return g >= -tolerance and f >= -tolerance and min(abs(g), abs(f)) <= 1e-2


@dataclass(frozen=True)
class Normal(RigidNormalLaw):
    """A law that is a certificate."""

    certificate: Certificate = sound

    def is_fulfilled(self, acceleration: float, force: float, tolerance: float) -> bool:
        return self.certificate(acceleration, force, tolerance)


DUMMIES: list[tuple[str, RigidNormalLaw]] = [
    ("accepts sustained contact", Normal(refusing)),
    ("no penetration", Normal(penetrating)),
    ("no tension", Normal(pulling)),
    ("complementarity", Normal(far_reaching)),
    ("scaling", Normal(absolute)),
]
