"""Coordinate: one generalised coordinate of a body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.parameters import Component, parameter


@final
@dataclass(frozen=True)
class Coordinate(Component):
    """A generalised coordinate q_i, its velocity u_i = dq_i/dt, where both start, and their sizes.

    Its unit is that in which the body's own functions take it; that of its velocity is the same per second.
    """

    name: str = parameter(doc="name of the coordinate", unit="")
    unit: str = parameter(doc="unit of the coordinate", unit="", choices=("m", "rad", "1"))
    start: float = parameter(0.0, doc="value at the start", unit="m or rad")
    rate: float = parameter(0.0, doc="velocity at the start", unit="m/s or rad/s")
    scale: float = parameter(1.0, doc="size below which errors of it count as absolute", unit="m or rad", above=0.0)
    rate_scale: float = parameter(
        1.0, doc="size below which errors of its velocity count as absolute", unit="m/s or rad/s", above=0.0
    )
