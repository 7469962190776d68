"""Plane, the boundary of a half-space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.parameters import parameter

from .ground import Ground


@final
@dataclass(frozen=True)
class Plane(Ground):
    """The plane z = height of the body frame; the body lies below, its normal is the frame's third axis."""

    height: float = parameter(0.0, doc="height over the origin of the body frame", unit="m")
