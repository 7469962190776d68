"""One impact with friction and energetic restitution at one contact, followed along its normal impulse."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, final

from nonsmooth.certificates import follows_map
from nonsmooth.compiled import compiled
from nonsmooth.interfaces import ImpactMap
from nonsmooth.parameters import parameter
from nonsmooth.types import Array, Floats

from .power import duration_parameter
from .slip_path import Matrix, Path, along_path, friction_from_rest, runs_straight, way_of_slip

_REST = 1e-9
"""Speed of slip or approach that counts as zero, relative to the approach speed."""
_GONE = 1e-12
"""Slip speed, relative to its start, below which a slip has ended."""
_STEP = 0.02
"""Largest turn of the slip direction in a step [rad], or largest relative change of the slip speed."""
_STEPS = 1_000_000
_HALVINGS = 60


@compiled
def _straight(rate: float, growth: float, stored: float, share: float, until: float) -> tuple[float, float, float]:
    """Return how far the normal impulse goes that changes the rate evenly, and rate and stored energy there.

    The expansion gives back a ``share`` of the stored energy; where none is left the impact is over.
    """
    done = 0.0
    while done < until:
        left = until - done
        if rate < 0.0 or (rate == 0.0 and growth < 0.0):
            step = min(left, -rate / growth if growth > 0.0 else math.inf)
            stored -= step * (rate + 0.5 * growth * step)
        else:
            given = share * stored
            if given <= 0.0:
                return done, rate, 0.0
            square = rate * rate + 2.0 * growth * given
            last = 2.0 * given / (rate + math.sqrt(square)) if square > 0.0 else math.inf
            step = min(left, -rate / growth if growth < 0.0 else math.inf)
            if last <= step:
                return done + last, rate + growth * last, 0.0
            stored -= step * (rate + 0.5 * growth * step) / share
        rate = rate + growth * step if step == left else 0.0
        done += step
    return done, rate, stored


@compiled
def _turning(path: Path, g: Matrix, mu: float, share: float) -> tuple[Path, float]:
    """Follow a slip until it runs straight or ends, or the impact does; return where, and the stored energy there."""
    stored, least = 0.0, _GONE * path[1]
    for _step in range(_STEPS):
        if path[1] <= least or (path[5] >= 0.0 and stored <= 0.0) or runs_straight(path[0], g, mu):
            break
        h = _STEP / (math.hypot(g[3], g[6]) + mu * (g[4] + g[8]))
        new = along_path(path, g, mu, h)
        opens = path[5] > 0.0 or (path[5] == 0.0 and new[5] > 0.0)
        worth = share if opens else 1.0
        if opens and worth == 0.0:
            return path, 0.0
        turns, over = new[5] * path[5] < 0.0, worth * stored < new[6] - path[6]
        if turns or over:
            # to where the approach ends or comes back, or the energy is spent
            low, high = 0.0, h
            for _halving in range(_HALVINGS):
                middle = 0.5 * (low + high)
                new = along_path(path, g, mu, middle)
                turns, over = new[5] * path[5] < 0.0, worth * stored < new[6] - path[6]
                low, high = (low, middle) if turns or over else (middle, high)
            new = along_path(path, g, mu, high)
            over = worth * stored < new[6] - path[6]
            if not over:
                new = new[0], new[1], new[2], new[3], new[4], 0.0, new[6]
        stored = 0.0 if over else stored - (new[6] - path[6]) / worth
        path = new
    return path, stored


@compiled
def _lone(rate: float, v1: float, v2: float, g: Matrix, mu: float, share: float) -> tuple[float, float, float]:
    """Return the impulses of a contact that collides by itself: slip, stick and new slip, compression and expansion."""
    slip = math.hypot(v1, v2)
    slip = slip if slip > _REST * -rate and mu > 0.0 else 0.0
    start = math.atan2(v2, v1), slip, 0.0, 0.0, 0.0, rate, 0.0
    (angle, left, normal, t1, t2, rate, _), stored = _turning(start, g, mu, share)
    if left > _GONE * slip and not (rate >= 0.0 and stored <= 0.0):
        growing = way_of_slip(angle, g, mu)[1]
        r1, r2 = -mu * math.cos(angle), -mu * math.sin(angle)
        until = -left / growing if growing < 0.0 else math.inf
        step, rate, stored = _straight(rate, g[0] + g[1] * r1 + g[2] * r2, stored, share, until)
        normal, t1, t2 = normal + step, t1 + r1 * step, t2 + r2 * step
    if not (rate >= 0.0 and stored <= 0.0):
        r1, r2 = friction_from_rest(g, mu)
        step, rate, stored = _straight(rate, g[0] + g[1] * r1 + g[2] * r2, stored, share, math.inf)
        normal, t1, t2 = normal + step, t1 + r1 * step, t2 + r2 * step
    return normal, t1, t2


def _impulses(
    n: int,
    delassus: Floats,
    rates: Floats,
    out: Floats,
    friction: Floats,
    restitution: Floats,
) -> None:
    """Let the one contact that approaches collide; it must leave no other one approaching."""
    hit = 0
    for i in range(3 * n):
        out[i] = 0.0
        if i % 3 == 0 and rates[i] < rates[3 * hit]:
            hit = i // 3
    c = 3 * hit
    if rates[c] >= 0.0:
        return
    one, two, three = 3 * n * c + c, 3 * n * (c + 1) + c, 3 * n * (c + 2) + c
    g = (
        delassus[one],
        delassus[one + 1],
        delassus[one + 2],
        delassus[two],
        delassus[two + 1],
        delassus[two + 2],
        delassus[three],
        delassus[three + 1],
        delassus[three + 2],
    )
    share = restitution[hit] * restitution[hit]
    p0, p1, p2 = _lone(rates[c], rates[c + 1], rates[c + 2], g, friction[hit], share)
    out[c], out[c + 1], out[c + 2] = p0, p1, p2
    for i in range(0, 3 * n, 3):
        line = 3 * n * i + c
        after = rates[i] + delassus[line] * p0 + delassus[line + 1] * p1 + delassus[line + 2] * p2
        if i != c and min(rates[i], after) < _REST * rates[c]:
            raise ValueError("Stronge's law is that of one contact; take EnergeticImpact where several collide")


@final
@dataclass(frozen=True)
class StrongeImpact(ImpactMap):
    """Energetic restitution and Coulomb friction at one contact.

    While the normal impulse grows the slip changes, and turns where the impulses push across it, until it ends; then
    the contact sticks if friction can hold it, or slips along the one direction that does not turn.  Expansion ends
    when the share e^2 of the work of compression has come back.  It never gains energy and is
    :class:`~laws.impact.energetic.EnergeticImpact` on a contact by itself.  Where the slip keeps to a line, all is in
    closed form.

    Contacts at rest that the impact lets go take no part.  Where others approach, before or by the impulse of the one,
    the law has no answer: the run ends and says so.  One coefficient serves for stick and slip, that of the slip before
    the impact.

    References
    ----------
    W. J. Stronge, "Rigid body collisions with friction", Proc. R. Soc. Lond. A 431 (1990) 169-181;
    J. B. Keller, "Impact with friction", Journal of Applied Mechanics 53 (1986) 1-4, for slip that turns.
    """

    one_contact: ClassVar[bool] = True

    restitution: float = parameter(doc="energetic coefficient of restitution e", minimum=0.0, maximum=1.0)
    duration: float = duration_parameter()

    @property
    def impulses(self) -> Callable[..., None]:
        """The map from rates to impulses, of one contact."""
        return _impulses

    @property
    def contact_time(self) -> float:
        """The parameter ``duration`` [s]."""
        return self.duration

    def is_fulfilled(self, delassus: Array, before: Array, impulses: Array, friction: Array, tolerance: float) -> bool:
        """Tell whether the impulses give the velocities of the law."""
        return follows_map(self, delassus, before, impulses, friction, tolerance)
