"""Lyapunov exponents: growth rates of perturbations of a motion, by QR on the maps of its periods."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.chart import Chart
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.inputs import check_positive
from nonsmooth.studies.orbits.linear import linear
from nonsmooth.studies.orbits.sections import StroboscopicSection, clearest_state, state_at
from nonsmooth.types import Array


@final
@dataclass(frozen=True)
class Lyapunov:
    """Lyapunov exponents of a motion.

    Attributes
    ----------
    exponents : array
        Lyapunov exponents, the largest first [1/s], shape [m].
    history : array
        Running estimates after each period [1/s], shape [n, m].
    left_out : int
        Number of periods without a derivative, because a small change reorders events.  The exponents leave them out.
    state : State
        Last state of the motion.
    """

    exponents: Array
    history: Array
    left_out: int
    state: State


def lyapunov(
    what: Varied, period: float, n_periods: int, *, settle: float = 0.0, within: Sequence[str] | None = None
) -> Lyapunov:
    """Return the Lyapunov exponents of a motion.

    Parameters
    ----------
    what : Scenario, System or Family
        The system.
    period : float
        Time after which the directions are made orthogonal again [s].
    n_periods : int
        Number of these periods.
    settle : float
        Time of the transient [s], which is left out of the exponents.
    within : sequence of str, optional
        Names of coordinates and velocities of the perturbations (:func:`orbit`).

    Raises
    ------
    InvalidInput
        If a number is not positive, different contacts are closed at the ends of two periods, or no period has a
        derivative.
    """
    for name, value in (("period", period), ("n_periods", n_periods)):
        check_positive(f"lyapunov: {name}", value, "Give a larger one.")
    model = Family.of(what).model()
    state = clearest_state(model, state_at(model, model.start, settle), period)
    sums, history, left_out = None, list[Array](), 0
    names, directions = Chart.at(model, state, within).names, None
    for _ in range(int(n_periods)):
        found = linear(model, state, StroboscopicSection(period), within)
        if found.chart.names != names:
            remedy = f"Take another one, or another settle; free were {', '.join(names)} at first."
            free = ", ".join(found.chart.names)
            raise InvalidInput("lyapunov: period", "must end with the same coordinates free each time", free, remedy)
        state = found.end.state
        if found.non_differentiable:
            left_out += 1
            continue
        start = np.eye(len(found.way)) if directions is None else directions
        directions, stretched = np.linalg.qr(found.matrix @ start)
        # the logarithm needs a positive stretch: a stretch of zero is replaced by the smallest positive number
        lengths = np.log(np.maximum(np.abs(np.diag(stretched)), np.finfo(float).tiny))
        sums = lengths if sums is None else sums + lengths
        history.append(sums / ((len(history) + 1) * period))
    if not history:
        raise InvalidInput("lyapunov", "must find a period with a derivative", n_periods, "Take more, or a longer one.")
    order = np.argsort(-history[-1], kind="stable")
    return Lyapunov(history[-1][order], np.array(history)[:, order], left_out, state)
