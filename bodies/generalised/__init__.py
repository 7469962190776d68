"""Bodies in generalised coordinates, defined by plain functions."""

from .body import GeneralisedBody
from .coordinate import Coordinate
from .frames import MovingFrame, PointFrame, TurningFrame

__all__ = ["Coordinate", "GeneralisedBody", "MovingFrame", "PointFrame", "TurningFrame"]
