"""The fully plastic impact."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces import ImpactMap
from nonsmooth.types import Array, Floats

from .cone import follows_cone, solve_rebound
from .power import duration_parameter


def _impulses(n: int, delassus: Floats, rates: Floats, out: Floats, friction: Floats) -> None:
    """G'+ >= 0 complementary to P_N >= 0; P_T in the disc against v+."""
    solve_rebound(n, delassus, rates, np.zeros(3 * n), out, friction)


@final
@dataclass(frozen=True)
class PlasticImpact(ImpactMap):
    """All contacts that push stay closed: the contact problem with Coulomb friction on the velocities after.

    Newton's, Moreau's and Poisson's laws are this one for e = 0.  It always loses energy, by at least that of the
    change of velocity, (u+ - u-)^T M (u+ - u-) / 2, and by just that without friction (Carnot's theorem).  The
    energetic law with e = 0 is another: there a contact may open again while others are still compressed.

    References
    ----------
    J. J. Moreau, "Unilateral contact and dry friction in finite freedom dynamics", CISM 302 (1988) 1-82.
    """

    duration: float = duration_parameter()

    @property
    def impulses(self) -> Callable[..., None]:
        """The map from rates to impulses."""
        return _impulses

    @property
    def contact_time(self) -> float:
        """The parameter ``duration`` [s]."""
        return self.duration

    def is_fulfilled(self, delassus: Array, before: Array, impulses: Array, friction: Array, tolerance: float) -> bool:
        """Tell whether impulses and rates after are complementary, and friction opposes v+."""
        return follows_cone(delassus, before, impulses, friction, tolerance, 0.0, 0.0)
