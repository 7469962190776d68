"""The interfaces: one abstract class a file, and the records that they return."""

from nonsmooth.interfaces.body import Body
from nonsmooth.interfaces.contact_kinematics import ContactKinematics
from nonsmooth.interfaces.convex_part import ConvexPart
from nonsmooth.interfaces.convex_shape import ConvexShape
from nonsmooth.interfaces.criterion import Criterion
from nonsmooth.interfaces.distance_backend import DistanceBackend
from nonsmooth.interfaces.engine import EndCause, Engine, Measure
from nonsmooth.interfaces.feature_pair import CandidateSearch, FeaturePair
from nonsmooth.interfaces.friction_law import AnisotropicFrictionLaw, FrictionLaw, StatefulFrictionLaw
from nonsmooth.interfaces.guard import Guard
from nonsmooth.interfaces.impact_law import ImpactLaw, ImpactMap, ImpactProcess
from nonsmooth.interfaces.joint import Joint
from nonsmooth.interfaces.load import Load
from nonsmooth.interfaces.look import Look
from nonsmooth.interfaces.motion import Motion
from nonsmooth.interfaces.normal_law import CompliantNormalLaw, NormalLaw, RigidNormalLaw
from nonsmooth.interfaces.scales import Scales
from nonsmooth.interfaces.scenario import Run, Scenario
from nonsmooth.interfaces.shape import Shape
from nonsmooth.interfaces.tangential_law import TangentialLaw
from nonsmooth.interfaces.traction_law import TractionLaw

__all__ = [
    "AnisotropicFrictionLaw",
    "Body",
    "CandidateSearch",
    "CompliantNormalLaw",
    "ContactKinematics",
    "ConvexPart",
    "ConvexShape",
    "Criterion",
    "DistanceBackend",
    "EndCause",
    "Engine",
    "FeaturePair",
    "FrictionLaw",
    "Guard",
    "ImpactLaw",
    "ImpactMap",
    "ImpactProcess",
    "Joint",
    "Load",
    "Look",
    "Measure",
    "Motion",
    "NormalLaw",
    "RigidNormalLaw",
    "Run",
    "Scales",
    "Scenario",
    "Shape",
    "StatefulFrictionLaw",
    "TangentialLaw",
    "TractionLaw",
]
