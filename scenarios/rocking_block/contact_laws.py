"""The laws of the contact between block and ground, the same in two and three dimensions."""

from __future__ import annotations

from typing import Any

from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral


def laws_of(restitution: float, exponent: float, friction: float) -> dict[str, Any]:
    """Return normal, friction and impact law for ``System.contact``."""
    return {
        "normal": Unilateral(),
        "friction": Coulomb(friction) if friction > 0.0 else Frictionless(),
        "impact": EnergeticImpact(restitution, exponent=exponent),
    }
