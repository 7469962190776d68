"""Built-in bodies, shapes, motions and contact pairs."""

from bodies.ball import Ball
from bodies.box_body import BoxBody
from bodies.capsule_body import CapsuleBody
from bodies.compound import Compound, Part
from bodies.contacts.plane_sphere import PlaneSphere
from bodies.contacts.sphere_sphere import SphereSphere
from bodies.cylinder_body import CylinderBody
from bodies.disc_body import DiscBody
from bodies.driven_body import DrivenBody
from bodies.dumbbell import Dumbbell
from bodies.ellipsoid_body import EllipsoidBody
from bodies.free import FreeBody
from bodies.line_body import LineBody
from bodies.motions.constant_velocity import ConstantVelocity
from bodies.motions.function_motion import FunctionMotion
from bodies.motions.harmonic import Harmonic
from bodies.motions.rest import Rest
from bodies.motions.table import Table
from bodies.planar_body import PlanarBody
from bodies.plate import Plate
from bodies.rigid_body import RigidBody
from bodies.rod import Rod
from bodies.shapes.plane import Plane
from bodies.shapes.sphere import Sphere

__all__ = [
    "Ball",
    "BoxBody",
    "CapsuleBody",
    "Compound",
    "ConstantVelocity",
    "CylinderBody",
    "DiscBody",
    "DrivenBody",
    "Dumbbell",
    "EllipsoidBody",
    "FreeBody",
    "FunctionMotion",
    "Harmonic",
    "LineBody",
    "Part",
    "PlanarBody",
    "Plane",
    "PlaneSphere",
    "Plate",
    "Rest",
    "RigidBody",
    "Rod",
    "Sphere",
    "SphereSphere",
    "Table",
]
