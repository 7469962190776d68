"""Newton's restitution in one step, with Coulomb friction on the velocities after the impact."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import ClassVar, final

from nonsmooth.interfaces import ImpactMap
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats


def _impulses(
    n: int,
    delassus: Floats,
    rates: Floats,
    out: Floats,
    friction: Floats,
    restitution: Floats,
) -> None:
    """Solve by projection, contact by contact: g'+ >= -e g'-, P_N >= 0, P_T in the disc against v+."""
    width = 3 * n
    for i in range(width):
        out[i] = 0.0
    for _sweep in range(100000):
        change = 0.0
        size = 0.0
        for a in range(n):
            line = 3 * a
            after = rates[line] + restitution[a] * min(rates[line], 0.0)
            for j in range(width):
                after += delassus[line * width + j] * out[j]
            old = out[line]
            out[line] = max(0.0, old - after / delassus[line * width + line])
            change = max(change, abs(out[line] - old))
            # a step of the projected gradient on the disc, short enough for any 2 x 2 block
            step = 1.0 / (delassus[(line + 1) * width + line + 1] + delassus[(line + 2) * width + line + 2])
            v1, v2 = rates[line + 1], rates[line + 2]
            for j in range(width):
                v1 += delassus[(line + 1) * width + j] * out[j]
                v2 += delassus[(line + 2) * width + j] * out[j]
            p1, p2 = out[line + 1] - step * v1, out[line + 2] - step * v2
            bound = friction[a] * out[line]
            norm = math.sqrt(p1 * p1 + p2 * p2)
            if norm > bound:
                p1, p2 = p1 * bound / norm, p2 * bound / norm
            change = max(change, abs(p1 - out[line + 1]), abs(p2 - out[line + 2]))
            out[line + 1], out[line + 2] = p1, p2
            size = max(size, out[line])
        if change <= 1e-15 * size:
            return


@final
@dataclass(frozen=True)
class NewtonImpact(ImpactMap):
    """Newton's law g'+ = -e g'- on all contacts at once, complementary, with Coulomb friction (Moreau's form).

    It knows no sequence of compressions: Newton's cradle and the dumbbell's drift come out wrong with it, and
    with friction it may gain energy (Kane's example).  It is here for comparison.

    References
    ----------
    J. J. Moreau, "Unilateral contact and dry friction in finite freedom dynamics", CISM 302 (1988) 1-82.
    """

    departures: ClassVar[Mapping[str, str]] = MappingProxyType(
        {"dissipation with friction": "restitution and friction are applied apart, as Kane's example shows"}
    )

    restitution: float = parameter(doc="kinematic coefficient of restitution e", minimum=0.0, maximum=1.0)
    duration: float = parameter(
        2e-5, doc="contact time T_c of the accumulation rule (33)", unit="s", minimum=0.0, usual=(1e-12, 1e-2)
    )

    @property
    def impulses(self) -> Callable[..., None]:
        """The map from rates to impulses."""
        return _impulses

    @property
    def contact_time(self) -> float:
        """The parameter ``duration`` [s]."""
        return self.duration

    def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
        """Tell whether no more energy [J] came back than went in."""
        return returned <= stored + tolerance
