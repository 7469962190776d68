"""Poisson's impact law: the impulse of compression comes back by the share e_P in expansion."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.interfaces import ImpactMap
from nonsmooth.parameters import parameter
from nonsmooth.types import Array, Floats

from .cone import cone_deviation, solve_cone, solve_rebound
from .power import duration_parameter


def _impulses(
    n: int,
    delassus: Floats,
    rates: Floats,
    out: Floats,
    friction: Floats,
    restitution: Floats,
) -> None:
    """Compression as a plastic impact; then P_N - P_Nc >= e P_Nc complementary to g'+ >= 0, friction against v+."""
    none, compression, least = np.zeros(3 * n), np.zeros(3 * n), np.zeros(n)
    solve_rebound(n, delassus, rates, none, out, friction)
    for i in range(3 * n):
        compression[i] = out[i]
    for a in range(n):
        least[a] = (1.0 + restitution[a]) * compression[3 * a]
    solve_cone(n, delassus, rates, none, compression, least, out, friction)
    if not math.isfinite(out[0]):
        # bodies wedged between others give nothing back
        for i in range(3 * n):
            out[i] = compression[i]


@final
@dataclass(frozen=True)
class PoissonImpact(ImpactMap):
    """Compression until nothing approaches, then expansion with e_P times the normal impulses of compression.

    Either phase is one contact problem with Coulomb friction on the velocities at its end; in expansion a contact
    may get more than its share where the others would push it in.

    With one e_P <= 1 for all contacts it always loses energy, (1 - e_P^2) P_c^T G P_c / 2 or more, and without friction
    with any e_P <= 1: the expansion makes P^T G P / 2 + z_c^T P least, and P = P_c is open to it.  With friction and
    different e_P it may gain energy.

    Where no expansion has an answer, as of bodies wedged between others, the impact ends with its compression.

    References
    ----------
    Ch. Glocker, F. Pfeiffer, "Multiple impacts with friction in rigid multibody systems", Nonlinear Dynamics 7 (1995)
    471-497, without their reversible tangential impulse.
    """

    restitution: float = parameter(doc="kinetic coefficient of restitution e_P", minimum=0.0, maximum=1.0)
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
        """Tell whether the impulses are some compression, itself complementary, and its expansion.

        The compression is the one that the law finds, of those there may be.
        """
        n = len(friction)
        none, least, compression = np.zeros(3 * n), np.zeros(n), np.zeros(3 * n)
        solve_cone(n, delassus.ravel(), before, none, none, least, compression, friction)
        missed = (
            cone_deviation(delassus, before, none, none, least, compression, friction),
            cone_deviation(
                delassus, before, none, compression, (1.0 + self.restitution) * compression[::3], impulses, friction
            ),
        )
        return float(np.max(missed)) <= tolerance
