"""Moreau's impact law with normal and tangential restitution."""

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
    tangential_restitution: Floats,
) -> None:
    """G'+ >= -e_N g'- complementary to P_N >= 0; P_T in the disc against v+ + e_T v-."""
    shift = np.zeros(3 * n)
    for a in range(n):
        shift[3 * a] = restitution[a] * min(rates[3 * a], 0.0)
        for r in range(1, 3):
            shift[3 * a + r] = tangential_restitution[a] * rates[3 * a + r]
    solve_rebound(n, delassus, rates, shift, out, friction)


@final
@dataclass(frozen=True)
class MoreauImpact(ImpactMap):
    """One contact problem for z+ + e z-, with coefficients of their own for normal and slip.

    Where friction is strong enough, slip comes back as v+ = -e_T v-, as with a ball of rubber.  With e_T = 0 it is
    Newton's law.  A contact that was separating counts with e_N = 0, so that nothing is left approaching.

    It always loses energy if all contacts approach or rest and have the same e_N = e_T <= 1, for then the work
    P^T (z+ + z-) / 2 is P^T (z+ + e z-) / (1 + e), which is not positive, less (1 - e) / (1 + e) P^T G P / 2.
    With e_N different from e_T it may gain energy where normal and slip are coupled (Kane's example, e_T = 0).  So may
    contacts with different e_N, even without friction.

    Where no velocities rebound at all contacts, as of a ball wedged between two walls, the impact is inelastic.

    References
    ----------
    J. J. Moreau, "Unilateral contact and dry friction in finite freedom dynamics", CISM 302 (1988) 1-82.
    """

    departures: ClassVar[Mapping[str, str]] = MappingProxyType(
        {"dissipation with friction": "with e_T other than e_N friction acts against a slip that never is"}
    )

    restitution: float = parameter(doc="normal coefficient of restitution e_N", minimum=0.0, maximum=1.0)
    tangential_restitution: float = parameter(
        0.0, doc="tangential coefficient of restitution e_T", minimum=0.0, maximum=1.0
    )
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
        """Tell whether impulses and z+ + e z- are complementary, and friction opposes the slip of that."""
        return follows_cone(
            delassus, before, impulses, friction, tolerance, self.restitution, self.tangential_restitution
        )
