"""Built-in contact laws: one law, one file."""

from laws.friction.anisotropic import Anisotropic
from laws.friction.bristle import Bristle
from laws.friction.contensou import CoulombContensou
from laws.friction.coulomb import Coulomb
from laws.friction.directional import Directional
from laws.friction.frictionless import Frictionless
from laws.friction.rate_and_state import RateAndState
from laws.friction.stribeck import Stribeck
from laws.friction.viscous import Viscous
from laws.impact.energetic import EnergeticImpact
from laws.impact.hertz import (
    HERTZ_EXPONENT,
    closing_time,
    contact_time,
    effective_modulus,
    effective_radius,
    hertz_stiffness,
)
from laws.impact.johnson import JohnsonImpact, johnson_restitution, johnson_speed
from laws.impact.mono_stiffness import MonoStiffnessImpact
from laws.impact.moreau import MoreauImpact
from laws.impact.newton import NewtonImpact
from laws.impact.plastic import PlasticImpact
from laws.impact.poisson import PoissonImpact
from laws.impact.stronge import StrongeImpact
from laws.impact.viscoelastic import ViscoelasticImpact, viscoelastic_restitution, viscoelastic_speed
from laws.normal.cohesive import Cohesive
from laws.normal.hertz import HertzCompliant
from laws.normal.hunt_crossley import HuntCrossley
from laws.normal.lankarani_nikravesh import LankaraniNikravesh
from laws.normal.linear import LinearCompliant
from laws.normal.unilateral import Unilateral

__all__ = [
    "HERTZ_EXPONENT",
    "Anisotropic",
    "Bristle",
    "Cohesive",
    "Coulomb",
    "CoulombContensou",
    "Directional",
    "EnergeticImpact",
    "Frictionless",
    "HertzCompliant",
    "HuntCrossley",
    "JohnsonImpact",
    "LankaraniNikravesh",
    "LinearCompliant",
    "MonoStiffnessImpact",
    "MoreauImpact",
    "NewtonImpact",
    "PlasticImpact",
    "PoissonImpact",
    "RateAndState",
    "Stribeck",
    "StrongeImpact",
    "Unilateral",
    "ViscoelasticImpact",
    "Viscous",
    "closing_time",
    "contact_time",
    "effective_modulus",
    "effective_radius",
    "hertz_stiffness",
    "johnson_restitution",
    "johnson_speed",
    "viscoelastic_restitution",
    "viscoelastic_speed",
]
