"""Newton's restitution in one step, with Coulomb friction on the velocities after the impact."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar, final

import numpy as np

from nonsmooth.interfaces import ImpactMap
from nonsmooth.parameters import parameter
from nonsmooth.types import Array, Floats

from .cone import follows_cone, solve_rebound
from .power import duration_parameter


def _impulses(
    n: int,
    delassus: Floats,
    rates: Floats,
    out: Floats,
    friction: Floats,
    restitution: Floats,
) -> None:
    """G'+ >= -e g'- complementary to P_N >= 0; P_T in the disc against v+."""
    shift = np.zeros(3 * n)
    for a in range(n):
        shift[3 * a] = restitution[a] * min(rates[3 * a], 0.0)
    solve_rebound(n, delassus, rates, shift, out, friction)


@final
@dataclass(frozen=True)
class NewtonImpact(ImpactMap):
    """Newton's law g'+ = -e g'- on all contacts at once, complementary, with Coulomb friction (Moreau's form).

    It knows no sequence of compressions: Newton's cradle and the dumbbell's drift come out wrong with it.  It is here
    for comparison.

    It always loses energy without friction, if all contacts approach or rest and have the same e.  It may gain energy
    with friction, even at one contact (Kane's example); and without, where contacts have different e or
    one separates while another strikes, because a separating contact counts with e = 0.

    Where no velocities rebound at all contacts, as of a ball wedged between two walls, the impact is inelastic.

    References
    ----------
    J. J. Moreau, "Unilateral contact and dry friction in finite freedom dynamics", CISM 302 (1988) 1-82.
    """

    departures: ClassVar[Mapping[str, str]] = MappingProxyType(
        {"dissipation with friction": "restitution and friction are applied apart, as Kane's example shows"}
    )

    restitution: float = parameter(doc="kinematic coefficient of restitution e", minimum=0.0, maximum=1.0)
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
        """Tell whether impulses and rates after are complementary, rebound included, and friction opposes v+."""
        return follows_cone(delassus, before, impulses, friction, tolerance, self.restitution, 0.0)
