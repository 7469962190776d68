"""Parameters fitted to measurements by least squares."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.checks import check_callable, floats, is_finite
from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.derivatives.flow import flow
from nonsmooth.studies.inputs import rising_times
from nonsmooth.types import Array

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult

Observe = Callable[[State], Any]
_STEP = 1e-5
"""Step of the differences that give the derivatives of the residuals, relative to the range of the parameter."""
_ROUND_OFF = 1e-7
"""A combination of parameters is taken as without effect if its effect on the observables is below this part of the
largest effect: runs have errors of 1e-12, and differences divide them by a step of 1e-5."""
_REFINED = 3
"""Number of starting points from which least squares is run: the points with the smallest sums of squares."""


@final
@dataclass(frozen=True)
class Fit:
    """Parameters fitted to measurements.

    Attributes
    ----------
    family : Family
        The systems, at the fitted values.
    observe : callable
        ``observe(state)`` returns the observables of a state.
    values : mapping of str to float
        The fitted parameters.
    standard_errors : mapping of str to float
        Standard error of each parameter, from the covariance.
    covariance : array
        Covariance of the parameters, shape [p, p].
    t : array
        Times [s], shape [n].
    measured, modelled : array
        Observables as measured, and of the fitted system, shape [n, k].
    deviation : float
        Standard deviation of measured less modelled observables, in the unit of the measurements.
    message : str
        Reason for the end of the search.
    """

    family: Family
    observe: Observe
    values: Mapping[str, float]
    standard_errors: Mapping[str, float]
    covariance: Array
    t: Array
    measured: Array
    modelled: Array
    deviation: float
    message: str


def fit(
    what: Varied,
    bounds: Mapping[str, tuple[float, float]],
    *,
    at: ArrayLike,
    measured: ArrayLike,
    observe: Observe,
    starts: int = 64,
) -> Fit:
    """Fit parameters to observations at given times by least squares.

    If impacts appear or vanish as a parameter changes, the sum of squares has many local minima.  Starting points are
    therefore spread evenly over the bounds (Sobol's sequence), and the search starts from the three best points.

    Parameters
    ----------
    what : Scenario, System or Family
        The system; its values are the first starting point.
    bounds : mapping of str to tuple of float
        Least and largest value of each parameter that is fitted.
    at : array
        Times of the measurements, rising [s], shape [n].
    measured : array
        Measurements, shape [n, k], or [n]; nan for a missing value.
    observe : callable
        ``observe(state)`` returns the observables of a state, shape [k].
    starts : int
        Number of further starting points, 0 or a power of two.

    Raises
    ------
    UnknownName
        If the system has no parameter of this name.
    InvalidInput
        If bounds, times or measurements are not valid, fewer numbers are measured than parameters are fitted, or the
        measurements do not determine the parameters.
    """
    check_callable("fit: observe", observe, "observe(state)")
    times = rising_times("fit: at", at)
    family, data = Family.of(what), _measurements(measured, len(times))
    problem = _Problem(family, tuple(bounds), *_bounds(family, bounds), times, data, observe)
    n_numbers = int(np.count_nonzero(np.isfinite(data)))
    if not bounds:
        raise InvalidInput("fit: bounds", "must name parameters", bounds, 'For example {"restitution": (0.5, 0.9)}.')
    if n_numbers < len(bounds):
        rule, remedy = "must be more numbers than parameters", "Measure more, or fit fewer."
        raise InvalidInput("fit: measured", rule, n_numbers, remedy)
    found = problem.solved(starts)
    values, width = problem.values(found.x), problem.high - problem.low
    deviation = float(np.sqrt(np.sum(found.fun**2) / max(1, n_numbers - len(bounds))))
    covariance = deviation**2 * _inverse(found.jac, problem.names) * np.outer(width, width)
    errors = dict(zip(bounds, np.sqrt(np.diag(covariance)).tolist(), strict=True))
    best = dict(zip(bounds, values.tolist(), strict=True))
    modelled = problem.modelled(values)
    message = str(found.message)
    return Fit(family.at(**best), observe, best, errors, covariance, times, data, modelled, deviation, message)


@final
@dataclass(frozen=True, eq=False)
class _Problem:
    """Differences of observables and measurements, as a function of parameters scaled to their bounds."""

    family: Family
    names: tuple[str, ...]
    low: Array
    high: Array
    times: Array
    data: Array
    observe: Observe

    def values(self, scaled: Array) -> Array:
        """Return the parameters for scaled values: 0 is the lower bound of a parameter, 1 its upper bound."""
        return self.low + scaled * (self.high - self.low)

    def modelled(self, values: Array) -> Array:
        """Return the observables of the model at all times, shape [n, k]."""
        model = self.family.model(**dict(zip(self.names, values.tolist(), strict=True)))
        return observed(model, self.times, self.observe)

    def residual(self, scaled: Array) -> Array:
        """Return modelled less measured observables, without missing measurements, shape [m]."""
        return np.asarray((self.modelled(self.values(scaled)) - self.data)[np.isfinite(self.data)])

    def cost(self, scaled: Array) -> float:
        """Return the sum of squared residuals; infinite if the run fails."""
        try:
            return float(np.sum(self.residual(scaled) ** 2))
        except (RunFailed, InvalidInput):
            return np.inf

    def solved(self, starts: int) -> OptimizeResult:
        """Return the best minimum reached from the best starting points; points from which a run fails are left out.

        Raises
        ------
        RunFailed, InvalidInput
            If a run fails in the search from each of these points.
        """
        from scipy.optimize import least_squares
        from scipy.stats.qmc import Sobol

        pairs = zip(self.names, self.low, self.high, strict=True)
        own = np.clip([(self.family[name] - a) / (b - a) for name, a, b in pairs], 0.0, 1.0)
        spread = Sobol(len(self.names), seed=0).random(starts) if starts else np.zeros((0, len(self.names)))
        points = np.concatenate([own[None], spread])
        order = np.argsort([self.cost(point) for point in points], kind="stable")
        found, trouble = list["OptimizeResult"](), list[RunFailed | InvalidInput]()
        for begin in points[order][:_REFINED]:
            inside = np.clip(begin, 1e-3, 1.0 - 1e-3)
            try:
                found.append(least_squares(self.residual, inside, bounds=(0.0, 1.0), diff_step=_STEP, xtol=1e-10))
            except (RunFailed, InvalidInput) as error:
                trouble.append(error)
        if not found:
            raise trouble[0]
        return min(found, key=lambda one: float(one.cost))


def _measurements(measured: ArrayLike, n: int) -> Array:
    """Return the measurements with a row for each time, shape [n, k]."""
    data = np.asarray(measured, dtype=float)
    if data.ndim not in (1, 2) or len(data) != n:
        remedy = "Put nan where nothing was measured."
        raise InvalidInput("fit: measured", f"must have a row for each of {n} times", data.shape, remedy)
    return data.reshape(n, -1)


def observed(model: Model, times: Array, observe: Observe) -> Array:
    """Return the observables of a motion at rising times [s], shape [n, k]."""
    state, rows = model.start, list[Array]()
    for time in times.tolist():
        state = flow(model, state, time).state
        row = np.atleast_1d(floats("fit: observe", observe(state)))
        if not np.all(np.isfinite(row)):
            remedy = "Of which state does it not?"
            raise InvalidInput("fit: observe", "must return finite numbers", row.tolist(), remedy)
        rows.append(row)
    return np.array(rows)


def _inverse(jacobian: Array, names: Sequence[str]) -> Array:
    """Return the inverse of J^T J; raise InvalidInput if a combination of parameters has no effect."""
    _, effects, ways = np.linalg.svd(jacobian, full_matrices=False)
    idle = effects <= _ROUND_OFF * effects[0]
    if np.any(idle):
        which = [name for name, part in zip(names, np.abs(ways[idle]).max(axis=0), strict=True) if part > 0.1]
        remedy = "Fit fewer, or measure what they change."
        raise InvalidInput("fit: bounds", "must be of parameters that the measurements tell", which, remedy)
    return np.asarray((ways.T / effects**2) @ ways)


def _bounds(family: Family, bounds: Mapping[str, tuple[float, float]]) -> tuple[Array, Array]:
    for name, (low, high) in bounds.items():
        value = family[name]
        if not (is_finite(low) and is_finite(high) and low < high and low <= value <= high):
            remedy = f"The search begins at {value:.9g}."
            raise InvalidInput(f"fit: bounds of {name}", "must be a range around where it begins", (low, high), remedy)
    return np.array([low for low, _ in bounds.values()]), np.array([high for _, high in bounds.values()])
