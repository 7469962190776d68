"""Built-in bodies, shapes, motions and contact pairs."""

from bodies.ball import Ball
from bodies.contacts.box_sphere import BoxSphere
from bodies.contacts.capsule_capsule import CapsuleCapsule
from bodies.contacts.capsule_sphere import CapsuleSphere
from bodies.contacts.cylinder_sphere import CylinderSphere
from bodies.contacts.disc_sphere import DiscSphere
from bodies.contacts.plane_box import PlaneBox
from bodies.contacts.plane_capsule import PlaneCapsule
from bodies.contacts.plane_cylinder import PlaneCylinder
from bodies.contacts.plane_disc import PlaneDisc
from bodies.contacts.plane_ellipsoid import PlaneEllipsoid
from bodies.contacts.plane_sphere import PlaneSphere
from bodies.contacts.sphere_sphere import SphereSphere
from bodies.dumbbell import Dumbbell
from bodies.free import FreeBody
from bodies.motions.harmonic import Harmonic
from bodies.motions.rest import Rest
from bodies.plate import Plate
from bodies.shapes.box import Box
from bodies.shapes.capsule import Capsule
from bodies.shapes.cylinder import Cylinder
from bodies.shapes.disc import Disc
from bodies.shapes.ellipsoid import Ellipsoid
from bodies.shapes.plane import Plane
from bodies.shapes.sphere import Sphere

__all__ = [
    "Ball",
    "Box",
    "BoxSphere",
    "Capsule",
    "CapsuleCapsule",
    "CapsuleSphere",
    "Cylinder",
    "CylinderSphere",
    "Disc",
    "DiscSphere",
    "Dumbbell",
    "Ellipsoid",
    "FreeBody",
    "Harmonic",
    "Plane",
    "PlaneBox",
    "PlaneCapsule",
    "PlaneCylinder",
    "PlaneDisc",
    "PlaneEllipsoid",
    "PlaneSphere",
    "Plate",
    "Rest",
    "Sphere",
    "SphereSphere",
]
