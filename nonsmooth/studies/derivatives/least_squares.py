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
"""Step of the differences of least squares, relative to the range of the parameter."""
_TOLD = 1e-7
"""Relative effect of a parameter below which it is round-off: that of runs, 1e-12, over the step."""
_REFINED = 3
"""Starting points that are refined."""


@final
@dataclass(frozen=True)
class Fit:
    """Parameters fitted to measurements.

    Attributes
    ----------
    family : Family
        The systems, at the values found.
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
        Standard deviation of their difference, in the unit of the measurements.
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

    If impacts come and go with a parameter, the sum of squares has many local minima.  Points are spread evenly over
    the bounds (Sobol), and the search starts from the three best.

    Parameters
    ----------
    what : Scenario, System or Family
        The system; its values are the first starting point.
    bounds : mapping of str to tuple of float
        Least and largest value of each parameter that is fitted.
    at : array
        Times of the measurements, rising [s], shape [n].
    measured : array
        Measurements, shape [n, k], or [n]; nan where one is missing.
    observe : callable
        ``observe(state)`` returns the observables of a state, shape [k].
    starts : int
        Further starting points, a power of two.

    Raises
    ------
    UnknownName
        If there is no such parameter.
    InvalidInput
        If bounds, times or measurements are not valid, there are fewer numbers than parameters, or the measurements do
        not determine the parameters.
    """
    from scipy.stats.qmc import Sobol

    check_callable("fit: observe", observe, "observe(state)")
    times = rising_times("fit: at", at)
    data = np.asarray(measured, dtype=float)
    if data.ndim not in (1, 2) or len(data) != len(times):
        remedy = "Put nan where nothing was measured."
        raise InvalidInput("fit: measured", f"must have a row for each of {len(times)} times", data.shape, remedy)
    data = data.reshape(len(times), -1)
    family, names = Family.of(what), tuple(bounds)
    low, high = _bounds(family, bounds)
    given = np.isfinite(data)
    if not names:
        raise InvalidInput("fit: bounds", "must name parameters", bounds, 'For example {"restitution": (0.5, 0.9)}.')
    if np.count_nonzero(given) < len(names):
        raise InvalidInput(
            "fit: measured",
            "must be more numbers than parameters",
            int(np.count_nonzero(given)),
            "Measure more, or fit fewer.",
        )

    def modelled(values: Array) -> Array:
        model = family.model(**dict(zip(names, values.tolist(), strict=True)))
        return observed(model, times, observe)

    def residual(shares: Array) -> Array:
        return np.asarray((modelled(low + shares * (high - low)) - data)[given])

    own = np.clip([(family[name] - a) / (b - a) for name, a, b in zip(names, low, high, strict=True)], 0.0, 1.0)
    spread = Sobol(len(names), seed=0).random(starts) if starts else np.zeros((0, len(names)))
    points = np.concatenate([own[None], spread])

    def cost(point: Array) -> float:
        try:
            return float(np.sum(residual(point) ** 2))
        except (RunFailed, InvalidInput):
            # a point at which nothing runs is no starting point
            return np.inf

    costs = np.array([cost(point) for point in points])
    found = _deepest(residual, points[np.argsort(costs, kind="stable")][:_REFINED])
    values = low + found.x * (high - low)
    freedom = max(1, len(found.fun) - len(names))
    deviation = float(np.sqrt(np.sum(found.fun**2) / freedom))
    covariance = deviation**2 * _inverse(found.jac, names) * np.outer(high - low, high - low)
    errors = np.sqrt(np.diag(covariance))
    best_values = dict(zip(names, values.tolist(), strict=True))
    return Fit(
        family.at(**best_values),
        observe,
        best_values,
        dict(zip(names, errors.tolist(), strict=True)),
        covariance,
        times,
        data,
        modelled(values),
        deviation,
        str(found.message),
    )


def observed(model: Model, times: Array, observe: Observe) -> Array:
    """Return the observables of a motion at rising times [s], shape [n, k]."""
    state, rows = model.start, list[Array]()
    for time in times.tolist():
        state = flow(model, state, time).state
        row = np.atleast_1d(floats("fit: observe", observe(state)))
        if not np.all(np.isfinite(row)):
            raise InvalidInput(
                "fit: observe", "must return finite numbers", row.tolist(), "Of which state does it not?"
            )
        rows.append(row)
    return np.array(rows)


def _deepest(residual: Callable[[Array], Array], begins: Array) -> OptimizeResult:
    """Return the best minimum of those reached from some points; points from which a run fails are left out.

    Raises
    ------
    RunFailed, InvalidInput
        If runs from all points fail.
    """
    found, trouble = list["OptimizeResult"](), list[RunFailed | InvalidInput]()
    for begin in begins:
        try:
            found.append(_refined(residual, begin))
        except (RunFailed, InvalidInput) as error:
            trouble.append(error)
    if not found:
        raise trouble[0]
    return min(found, key=lambda one: float(one.cost))


def _refined(residual: Callable[[Array], Array], begin: Array) -> OptimizeResult:
    from scipy.optimize import least_squares

    inside = np.clip(begin, 1e-3, 1.0 - 1e-3)
    return least_squares(residual, inside, bounds=(0.0, 1.0), diff_step=_STEP, xtol=1e-10)


def _inverse(jacobian: Array, names: Sequence[str]) -> Array:
    """Return the inverse of J^T J; InvalidInput if a combination of parameters changes nothing."""
    _, effects, ways = np.linalg.svd(jacobian, full_matrices=False)
    idle = effects <= _TOLD * effects[0]
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
