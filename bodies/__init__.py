"""Built-in bodies, shapes, motions, contact pairs, joints and loads."""

from bodies.ball import Ball
from bodies.contacts.plane_sphere import PlaneSphere
from bodies.contacts.sphere_sphere import SphereSphere
from bodies.dumbbell import Dumbbell
from bodies.free import FreeBody
from bodies.joints.ball_joint import BallJoint
from bodies.joints.distance import Distance
from bodies.joints.fixed import Fixed
from bodies.joints.hinge import Hinge
from bodies.joints.slider import Slider
from bodies.loads.bushing import Bushing
from bodies.loads.function_load import FunctionLoad
from bodies.loads.spring import Spring
from bodies.loads.torsion_spring import TorsionSpring
from bodies.motions.harmonic import Harmonic
from bodies.motions.rest import Rest
from bodies.plate import Plate
from bodies.shapes.plane import Plane
from bodies.shapes.sphere import Sphere

__all__ = [
    "Ball",
    "BallJoint",
    "Bushing",
    "Distance",
    "Dumbbell",
    "Fixed",
    "FreeBody",
    "FunctionLoad",
    "Harmonic",
    "Hinge",
    "Plane",
    "PlaneSphere",
    "Plate",
    "Rest",
    "Slider",
    "Sphere",
    "SphereSphere",
    "Spring",
    "TorsionSpring",
]
