"""HalfSpace, all that lies below a plane."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from nonsmooth.parameters import parameter

from .ground import Ground


@final
@dataclass(frozen=True)
class HalfSpace(Ground):
    """The solid z <= height of the body frame, with contacts like those of a :class:`bodies.Plane`, which bounds it.

    A slope, a wall or a ceiling is one on a body that is turned: ``Plate(Rest(orientation=...))``, or a
    :class:`bodies.DrivenBody` that carries it.
    """

    height: float = parameter(0.0, doc="height of its surface over the origin of the body frame", unit="m")
