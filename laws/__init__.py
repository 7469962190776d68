"""Built-in contact laws: one law, one file."""

from laws.friction.coulomb import Coulomb
from laws.friction.frictionless import Frictionless
from laws.friction.stribeck import Stribeck
from laws.impact.energetic import EnergeticImpact
from laws.impact.hertz import closing_time, contact_time, plane_strain_modulus
from laws.impact.newton import NewtonImpact
from laws.normal.unilateral import Unilateral

__all__ = [
    "Coulomb",
    "EnergeticImpact",
    "Frictionless",
    "NewtonImpact",
    "Stribeck",
    "Unilateral",
    "closing_time",
    "contact_time",
    "plane_strain_modulus",
]
