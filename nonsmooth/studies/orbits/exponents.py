"""Lyapunov exponents: how fast neighbours of a motion part, along orthogonal directions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import is_finite
from nonsmooth.errors import InvalidInput
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.chart import Chart
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.orbits.choosing import chosen, seen
from nonsmooth.studies.orbits.linear import linear
from nonsmooth.studies.orbits.sections import Strobe

Floats = NDArray[np.float64]


@final
@dataclass(frozen=True)
class Lyapunov:
    """Lyapunov exponents of a motion.

    Attributes
    ----------
    exponents : array
        The largest first [1/s], shape [m].
    history : array
        What they are after each period [1/s], shape [n, m].
    left_out : int
        Periods that a motion passed without a derivative, as events changed their order; they count for nothing.
    state : State
        Where the motion has come to.
    """

    exponents: Floats
    history: Floats
    left_out: int
    state: State


def lyapunov(
    what: Varied,
    period: float,
    n_periods: int,
    *,
    settle: float = 0.0,
    within: Sequence[str] | None = None,
) -> Lyapunov:
    """Follow a motion, and what becomes of its neighbours.

    Parameters
    ----------
    what : Scenario, System or Family
        The system.
    period : float
        Time after which the directions are made orthogonal anew [s].
    n_periods : int
        How often.
    settle : float
        Time to run before [s].
    within : sequence of str, optional
        Names of coordinates and velocities along which neighbours are (:func:`orbit`).

    Raises
    ------
    InvalidInput
        If a number is not valid, or periods end with now these contacts closed, now others.
    """
    for name, value in (("period", period), ("n_periods", n_periods)):
        if not (is_finite(value) and value > 0):
            raise InvalidInput(f"lyapunov: {name}", "must be positive and finite", value, "Give a larger one.")
    model = Family.of(what).model()
    state = chosen(model, seen(model, model.start, settle), period)
    sums, told, left_out = None, list[Floats](), 0
    names, directions = Chart.at(model, state, within).names, None
    for _ in range(int(n_periods)):
        found = linear(model, state, Strobe(period), within)
        if found.chart.names != names:
            remedy = f"Take another one, or another settle; free were {', '.join(names)} at first."
            free = ", ".join(found.chart.names)
            raise InvalidInput("lyapunov: period", "must end with the same coordinates free each time", free, remedy)
        state = found.end.state
        if found.corners:
            left_out += 1
            continue
        start = np.eye(len(found.way)) if directions is None else directions
        directions, stretched = np.linalg.qr(found.matrix @ start)
        # a direction that a period makes vanish stays the least number there is
        lengths = np.log(np.maximum(np.abs(np.diag(stretched)), np.finfo(float).tiny))
        sums = lengths if sums is None else sums + lengths
        told.append(sums / ((len(told) + 1) * period))
    if not told:
        raise InvalidInput("lyapunov", "must find a period with a derivative", n_periods, "Take more, or a longer one.")
    order = np.argsort(-told[-1], kind="stable")
    return Lyapunov(told[-1][order], np.array(told)[:, order], left_out, state)
