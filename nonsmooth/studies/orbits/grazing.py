"""Distance of an orbit to grazing and to simultaneous impacts, and the parameter at which it vanishes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.engine.memory.modes import Cause
from nonsmooth.histories.history import History
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import State
from nonsmooth.studies.orbits.periodic import Orbit
from nonsmooth.types import Array

SIMULTANEOUS = "simultaneous impacts"
_KINDS = {"approach": "grazing", "gap": "grazing", "between_impacts": SIMULTANEOUS}
"""Kind of change at which each distance vanishes, by the field of :class:`GrazingDistance`."""
_CANDIDATES = 200
"""Number of equal parts of a run in which minima of gaps are searched for.  Each part gives at most one minimum of a
contact's gap."""
_CLOSED, _COLLIDES = 1, 2
"""Bits of the mode code of a contact: closed, and colliding."""
_POINTS = 4
"""Largest number of last orbits from which the parameter of grazing, at which a distance is zero, is extrapolated: they
give a cubic polynomial."""
_GROWS = 1.5
"""Least ratio of the distances to grazing of two orbits that are used together to extrapolate the parameter of grazing:
nearly equal distances would amplify their errors."""
_LITTLE = 1e-2
"""Largest distance to grazing, relative to its scale, from which the parameter of grazing is extrapolated: a few orbits
predict it well only from nearby."""


@final
@dataclass(frozen=True)
class GrazingDistance:
    """Distances of an orbit to a change of its events; infinite if the orbit has no such impacts or gaps.

    Attributes
    ----------
    approach : float
        Least approach speed of an impact [m/s].
    gap : float
        Least gap of contacts that come near without an impact [m].
    between_impacts : float
        Least time between successive impacts of different contacts [s].
    scales : tuple of float
        Scales of these distances: the largest rate of a gap [m/s], the largest gap [m], the period [s].
    """

    approach: float
    gap: float
    between_impacts: float
    scales: tuple[float, float, float]


def grazing_distance(orbit: Orbit) -> GrazingDistance:
    """Simulate one period of an orbit, and return its distances to grazing and to simultaneous impacts."""
    model, end, state = orbit.family.model(), orbit.map.end.state.time, orbit.state
    approach, gap, impacts = [np.inf], [np.inf], list[tuple[float, int]]()
    fastest = widest = 0.0
    # the guard of a Poincare section ends each run at a passage: an orbit of several passages needs several runs
    while end - state.time > 1e-9 * orbit.period:
        run = model.run(end, start=state, sample_interval=end - state.time)
        events, state = run.events, run.state
        for i in np.flatnonzero(events.cause == Cause.IMPACT).tolist():
            impacts.append((float(events.time[i]), int(events.contact[i])))
            before = State.at(model.system, float(events.time[i]), events.q[i], events.u_before[i])
            collide = events.during[i] & _COLLIDES != 0
            approach.append(float(np.min(-model.contact_rates(before)[1][collide, 0], initial=np.inf)))
        times = np.linspace(run.t[0], run.t_end, _CANDIDATES + 1)
        motion = run.history("gap", "normal_velocity", times=times)
        fastest = max(fastest, _largest(np.abs(motion["normal_velocity"])))
        widest = max(widest, _largest(motion["gap"]))
        gap += _least_gaps(run, times, motion)
    scales = fastest, widest, orbit.period
    return GrazingDistance(min(approach), min(gap), _least_time(impacts, orbit.period), scales)


@final
@dataclass(frozen=True)
class PredictedChange:
    """A change of events beyond the last orbit of a branch, extrapolated from the distances of the orbits.

    Attributes
    ----------
    kind : str
        "grazing" or "simultaneous impacts".
    value : float
        Value of the parameter at the change.
    error : float
        Estimated error of the value: difference from the extrapolation with one orbit fewer; infinite for two orbits.
    """

    kind: str
    value: float
    error: float


def predicted_change(along: Array, values: Array, found: Sequence[GrazingDistance]) -> PredictedChange | None:
    """Return the first change of events just beyond the last orbit of a branch; None if no distance vanishes there.

    Parameters
    ----------
    along : array
        Arc length of the orbits, shape [n].
    values : array
        Values of the parameter at the orbits, shape [n].
    found : sequence of GrazingDistance
        Distances of the orbits.
    """
    from scipy.interpolate import BarycentricInterpolator

    nearest: tuple[float, PredictedChange] | None = None
    for (name, kind), scale in zip(_KINDS.items(), found[-1].scales, strict=True):
        left = np.array([getattr(one, name) for one in found])
        which = _graded(left)
        if left[-1] > _LITTLE * scale or len(which) < 2:
            continue
        # interpolate the parameter as a function of the distance. The inverse function, the distance as a function of
        # the parameter, may vanish like a square root, with an infinite slope
        there = np.column_stack([along, values])
        beyond, value = BarycentricInterpolator(left[which], there[which])(0.0).tolist()
        fewer = BarycentricInterpolator(left[which[:-1]], values[which[:-1]])(0.0) if len(which) > 2 else np.inf
        beyond -= along[-1]
        is_near = abs(beyond) <= along[-1] - along[which[-1]]
        if is_near and (nearest is None or beyond < nearest[0]):
            nearest = beyond, PredictedChange(kind, value, abs(float(fewer) - value))
    return None if nearest is None else nearest[1]


def _graded(left: Array) -> list[int]:
    """Return the indices of the orbits from whose distances the parameter of grazing is extrapolated.

    ``left`` are the distances to grazing of successive orbits, shape [n].  The choice begins with the last orbit and
    goes backwards.  It ends when a distance does not increase, or after :data:`_POINTS` orbits.  Each chosen distance
    is at least :data:`_GROWS` times the previously chosen distance.
    """
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


def _least_gaps(run: Solution, times: Array, motion: History) -> list[float]:
    """Return the local minima in time of the gaps of open contacts [m]: bodies approach, then separate, no impact."""
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


def _largest(numbers: Array) -> float:
    """Return the largest number without nan; 0 if all are nan, because the bodies of all contacts are far apart."""
    return float(np.max(np.nan_to_num(numbers), initial=0.0))


def _least_time(impacts: Sequence[tuple[float, int]], period: float) -> float:
    """Return the least time between successive impacts of different contacts in a periodic motion [s]."""
    again = [(impacts[0][0] + period, impacts[0][1])] if impacts else []
    pairs = zip(impacts, [*impacts[1:], *again], strict=True)
    return min((later[0] - one[0] for one, later in pairs if later[1] != one[1]), default=np.inf)
