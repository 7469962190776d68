"""Bodies in generalised coordinates, defined by plain functions."""

from bodies.generalised.body import GeneralisedBody
from bodies.generalised.coordinate import Coordinate
from bodies.generalised.frames import MovingFrame, PointFrame, TurningFrame

__all__ = ["Coordinate", "GeneralisedBody", "MovingFrame", "PointFrame", "TurningFrame"]
