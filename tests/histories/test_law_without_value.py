"""A run whose friction law has no value at rest can be printed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import nonsmooth as ns
from bodies import Ball, Plate
from laws import EnergeticImpact, Unilateral
from nonsmooth.certificates import opposes_slip
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.parameters import parameter


@dataclass(frozen=True)
class Logarithm(FrictionLaw):
    """Friction that grows with the logarithm of the slip speed."""

    scale: float = parameter(0.3, doc="growth per factor e of the speed")

    @staticmethod
    def coefficient(speed: float, scale: float) -> float:
        """Return the coefficient [1] at a slip speed [m/s]."""
        return scale * math.log(speed)

    def is_fulfilled(self, slip: Any, normal_force: float, tangential_force: Any, tolerance: float) -> bool:
        """Tell whether a force obeys the law."""
        return opposes_slip(self, slip, normal_force, tangential_force, tolerance)


def test_it_is_printed() -> None:
    floor, ball = Plate(), Ball(0.01)
    system = ns.System([floor, ball])
    system.contact(ball, floor, normal=Unilateral(), friction=Logarithm(), impact=EnergeticImpact(0.5))
    system.place(ball, position=(0.0, 0.0, 0.11), velocity=(50.0, 0.0, 0.0))
    assert "done" in repr(ns.simulate(system, 0.3))
