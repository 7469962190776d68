"""Built-in contact laws: one law, one file."""

from laws.friction.coulomb import Coulomb
from laws.friction.frictionless import Frictionless
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
    plane_strain_modulus,
)
from laws.impact.johnson import JohnsonImpact, johnson_restitution, johnson_speed
from laws.impact.mono_stiffness import MonoStiffnessImpact
from laws.impact.moreau import MoreauImpact
from laws.impact.newton import NewtonImpact
from laws.impact.plastic import PlasticImpact
from laws.impact.poisson import PoissonImpact
from laws.impact.stronge import StrongeImpact
from laws.impact.viscoelastic import ViscoelasticImpact, viscoelastic_restitution, viscoelastic_speed
from laws.normal.unilateral import Unilateral

__all__ = [
    "HERTZ_EXPONENT",
    "Coulomb",
    "EnergeticImpact",
    "Frictionless",
    "JohnsonImpact",
    "MonoStiffnessImpact",
    "MoreauImpact",
    "NewtonImpact",
    "PlasticImpact",
    "PoissonImpact",
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
    "plane_strain_modulus",
    "viscoelastic_restitution",
    "viscoelastic_speed",
]
