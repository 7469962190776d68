"""Coordinate: one generalised coordinate of a body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.parameters import Component, parameter


@final
@dataclass(frozen=True)
class Coordinate(Component):
    """A generalised coordinate q_i, its velocity u_i = dq_i/dt, where both start, and their sizes.

    The units are those of the body's own functions: metres and radians as a rule.
    """

    name: str = parameter(doc="name of the coordinate", unit="")
    start: float = parameter(0.0, doc="value at the start", unit="m or rad")
    rate: float = parameter(0.0, doc="velocity at the start", unit="m/s or rad/s")
    scale: float = parameter(1.0, doc="size below which errors of it count as absolute", unit="m or rad", above=0.0)
    rate_scale: float = parameter(
        1.0, doc="size below which errors of its velocity count as absolute", unit="m/s or rad/s", above=0.0
    )
