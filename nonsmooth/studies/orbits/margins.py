"""How far an orbit is from grazing, and from two impacts at once; and where along a branch nothing of that is left."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.modes import Cause
from nonsmooth.histories.history import History
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import State
from nonsmooth.studies.orbits.periodic import Orbit

Floats = NDArray[np.float64]
_LOOKED_AT = 200
"""Times of a period between which least gaps are looked for."""
_CLOSED, _COLLIDES = 1, 2
"""Bits of Eq. (29)."""
_KINDS = {"approach": "grazing", "gap": "grazing", "apart": "corner"}
_POINTS, _GROWS = 4, 1.5
"""So many orbits tell where a margin ends, of which each has one so many times as large as the next."""
_LITTLE = 1e-2
"""What a margin is at most over what it is compared with, where it is said to vanish."""


@final
@dataclass(frozen=True)
class Margins:
    """What is left until something happens to the events of an orbit; infinite where it cannot.

    Attributes
    ----------
    approach : float
        Least speed at which bodies that collide approach each other [m/s].
    gap : float
        Least gap of contacts that come near and are not hit [m].
    apart : float
        Least time between successive impacts of different contacts [s].
    beside : tuple of float
        What they are little beside: the largest speed at which a gap changes [m/s], the largest gap [m], the period
        [s].
    """

    approach: float
    gap: float
    apart: float
    beside: tuple[float, float, float]


def margins(orbit: Orbit) -> Margins:
    """Return the margins of an orbit, from one more run of it."""
    model, end, state = orbit.family.model(), orbit.map.end.state.time, orbit.state
    approach, gap, impacts = [np.inf], [np.inf], list[tuple[float, int]]()
    fastest = widest = 0.0
    # where a section ends runs, an orbit that passes it several times is one of several
    while end - state.time > 1e-9 * orbit.period:
        run = model.run(end, start=state, sample_interval=end - state.time)
        events, state = run.events, run.state
        for i in np.flatnonzero(events.cause == Cause.IMPACT).tolist():
            impacts.append((float(events.time[i]), int(events.contact[i])))
            before = State.at(model.system, float(events.time[i]), events.q[i], events.u_before[i])
            collide = events.during[i] & _COLLIDES != 0
            approach.append(float(np.min(-model.contact_rates(before)[1][collide, 0], initial=np.inf)))
        times = np.linspace(run.t[0], run.t_end, _LOOKED_AT + 1)
        motion = run.history("gap", "normal_velocity", times=times)
        fastest = max(fastest, _largest(np.abs(motion["normal_velocity"])))
        widest = max(widest, _largest(motion["gap"]))
        gap += _least_gaps(run, times, motion)
    beside = fastest, widest, orbit.period
    return Margins(min(approach), min(gap), _least_time(impacts, orbit.period), beside)


@final
@dataclass(frozen=True)
class Foretold:
    """What the margins of some orbits say that happens behind the last of them.

    Attributes
    ----------
    kind : str
        "grazing" or "corner".
    value : float
        The parameter there.
    error : float
        By how much that of one orbit fewer differs; infinite where there are two.
    """

    kind: str
    value: float
    error: float


def foretold(along: Floats, values: Floats, found: Sequence[Margins]) -> Foretold | None:
    """Return what happens first just behind the last of some orbits, as their margins vanish there.

    Parameters
    ----------
    along : array
        Where the orbits are along the arc, shape [n].
    values : array
        Their values of the parameter, shape [n].
    found : sequence of Margins
        Their margins.
    """
    from scipy.interpolate import BarycentricInterpolator

    nearest: tuple[float, Foretold] | None = None
    for (name, kind), beside in zip(_KINDS.items(), found[-1].beside, strict=True):
        left = np.array([getattr(one, name) for one in found])
        which = _graded(left)
        if left[-1] > _LITTLE * beside or len(which) < 2:
            continue
        # the margin is the abscissa: one that vanishes like a root has no slope over the parameter
        there = np.column_stack([along, values])
        beyond, value = BarycentricInterpolator(left[which], there[which])(0.0).tolist()
        fewer = BarycentricInterpolator(left[which[:-1]], values[which[:-1]])(0.0) if len(which) > 2 else np.inf
        beyond -= along[-1]
        near = abs(beyond) <= along[-1] - along[which[-1]]
        if near and (nearest is None or beyond < nearest[0]):
            nearest = beyond, Foretold(kind, value, abs(float(fewer) - value))
    return None if nearest is None else nearest[1]


def _graded(left: Floats) -> list[int]:
    """Return the last of some margins, and those before it that are ever larger."""
    if not np.isfinite(left[-1]):
        return []
    which = [len(left) - 1]
    for i in range(len(left) - 2, -1, -1):
        if not left[i] > left[i + 1]:
            break
        if left[i] >= _GROWS * left[which[-1]] and np.isfinite(left[i]):
            which.append(i)
        if len(which) == _POINTS:
            break
    return which


def _least_gaps(run: Solution, times: Floats, motion: History) -> list[float]:
    """Return the least gaps of the contacts that come near in a run, and are not hit [m]."""
    from scipy.optimize import brentq

    events = run.events
    which = np.searchsorted(events.time, times, side="right") - 1
    took_part = np.cumsum((events.before | events.during | events.after) != 0, axis=0)[which]
    is_open = events.after[which] & _CLOSED == 0
    turns = (motion["normal_velocity"][:-1] < 0.0) & (motion["normal_velocity"][1:] >= 0.0)
    passes = turns & is_open[:-1] & is_open[1:] & (took_part[:-1] == took_part[1:])
    found = []
    for i, contact in np.argwhere(passes).tolist():

        def rate(time: float, contact: int = contact) -> float:
            return float(run.history("normal_velocity", times=time, of=contact)["normal_velocity"][0])

        nearest = brentq(rate, times[i], times[i + 1], xtol=1e-13)
        found.append(float(run.history("gap", times=nearest, of=contact)["gap"][0]))
    return found


def _largest(numbers: Floats) -> float:
    """Return the largest of some numbers, where all contacts may be too far for any."""
    return float(np.max(np.nan_to_num(numbers), initial=0.0))


def _least_time(impacts: Sequence[tuple[float, int]], period: float) -> float:
    """Return the least time between successive impacts of different contacts in a motion that repeats [s]."""
    again = [(impacts[0][0] + period, impacts[0][1])] if impacts else []
    pairs = zip(impacts, [*impacts[1:], *again], strict=True)
    return min((later[0] - one[0] for one, later in pairs if later[1] != one[1]), default=np.inf)
