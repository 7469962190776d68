"""Built-in bodies, shapes, motions and contact pairs."""

from bodies.ball import Ball
from bodies.contacts.plane_sphere import PlaneSphere
from bodies.contacts.plane_vertex import PlaneVertex
from bodies.contacts.sphere_sphere import SphereSphere
from bodies.dumbbell import Dumbbell
from bodies.free import FreeBody
from bodies.generalised import Coordinate, GeneralisedBody, PointFrame, TurningFrame
from bodies.motions.harmonic import Harmonic
from bodies.motions.rest import Rest
from bodies.plate import Plate
from bodies.shapes.plane import Plane
from bodies.shapes.point import Point
from bodies.shapes.sphere import Sphere

__all__ = [
    "Ball",
    "Coordinate",
    "Dumbbell",
    "FreeBody",
    "GeneralisedBody",
    "Harmonic",
    "Plane",
    "PlaneSphere",
    "PlaneVertex",
    "Plate",
    "Point",
    "PointFrame",
    "Rest",
    "Sphere",
    "SphereSphere",
    "TurningFrame",
]
