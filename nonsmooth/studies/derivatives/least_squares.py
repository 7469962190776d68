"""Parameters fitted to what was measured, by least squares."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.checks import check_callable, floats, is_finite
from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.family import Family, Varied
from nonsmooth.studies.derivatives.passage import passage

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult

Floats = NDArray[np.float64]
Observe = Callable[[State], Any]
_STEP = 1e-5
"""Change of a parameter over its range in differences: of least squares, which need no more."""
_TOLD = 1e-7
"""Effect over the largest one below which it is round-off: that of runs is 1e-12, over the step."""
_REFINED = 3
"""Points from which the search begins."""


@final
@dataclass(frozen=True)
class Fit:
    """A fit.

    Attributes
    ----------
    family : Family
        What was fitted, at the values found.
    observe : callable
        ``observe(state)`` returns what was measured of a state.
    values : mapping of str to float
        The parameters found.
    standard_errors : mapping of str to float
        Of each, from the covariance.
    covariance : array
        Of the parameters, shape [p, p].
    t : array
        Times [s], shape [n].
    measured, modelled : array
        What was measured, and what the fitted system has, shape [n, k].
    deviation : float
        Standard deviation of their difference, in the unit of what was measured.
    message : str
        Why the search ended.
    """

    family: Family
    observe: Observe
    values: Mapping[str, float]
    standard_errors: Mapping[str, float]
    covariance: Floats
    t: Floats
    measured: Floats
    modelled: Floats
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
    """Fit parameters so that what is observed at given times comes closest to what was measured.

    Where impacts come and go with a parameter, least squares have many hollows: the search begins in the deepest of
    those that points spread evenly over the bounds lie in.

    Parameters
    ----------
    what : Scenario, System or Family
        The system; its values are where the search begins.
    bounds : mapping of str to tuple of float
        Least and largest value of each parameter that is fitted.
    at : array
        Times of the measurements, rising [s], shape [n].
    measured : array
        Shape [n, k], or [n]; nan where nothing was measured.
    observe : callable
        ``observe(state)`` returns what is measured of a state, shape [k].
    starts : int
        Points besides that of the system from which the search may begin, a power of two; it does from the best three.

    Raises
    ------
    UnknownName
        If there is no such parameter.
    InvalidInput
        If bounds, times or measurements are not valid, there are fewer numbers than parameters, or the measurements do
        not tell what these are.
    """
    from scipy.stats.qmc import Sobol

    check_callable("fit: observe", observe, "observe(state)")
    times = np.atleast_1d(floats("fit: at", at))
    if not (len(times) and times[0] > 0.0 and np.all(np.diff(times) > 0.0)):
        raise InvalidInput("fit: at", "must be positive, rising times", times.tolist(), "Give them in [s].")
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

    def modelled(values: Floats) -> Floats:
        model = family.model(**dict(zip(names, values.tolist(), strict=True)))
        return observed(model, times, observe)

    def residual(shares: Floats) -> Floats:
        return np.asarray((modelled(low + shares * (high - low)) - data)[given])

    own = np.clip([(family[name] - a) / (b - a) for name, a, b in zip(names, low, high, strict=True)], 0.0, 1.0)
    spread = Sobol(len(names), seed=0).random(starts) if starts else np.zeros((0, len(names)))
    points = np.concatenate([own[None], spread])

    def cost(point: Floats) -> float:
        try:
            return float(np.sum(residual(point) ** 2))
        except (RunFailed, InvalidInput):
            # a point in which nothing runs is no place to begin
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


def observed(model: Model, times: Floats, observe: Observe) -> Floats:
    """Return what is observed of a motion at rising times [s], shape [n, k]."""
    state, rows = model.start, list[Floats]()
    for time in times.tolist():
        state = passage(model, state, time).state
        row = np.atleast_1d(floats("fit: observe", observe(state)))
        if not np.all(np.isfinite(row)):
            raise InvalidInput(
                "fit: observe", "must return finite numbers", row.tolist(), "Of which state does it not?"
            )
        rows.append(row)
    return np.array(rows)


def _deepest(residual: Callable[[Floats], Floats], begins: Floats) -> OptimizeResult:
    """Return the best of what is found from some points; what leads where no run is counts for nothing.

    Raises
    ------
    RunFailed, InvalidInput
        If all do.
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


def _refined(residual: Callable[[Floats], Floats], begin: Floats) -> OptimizeResult:
    from scipy.optimize import least_squares

    inside = np.clip(begin, 1e-3, 1.0 - 1e-3)
    return least_squares(residual, inside, bounds=(0.0, 1.0), diff_step=_STEP, xtol=1e-10)


def _inverse(jacobian: Floats, names: Sequence[str]) -> Floats:
    """Return the inverse of J^T J; without one there are combinations of parameters that change nothing."""
    _, effects, ways = np.linalg.svd(jacobian, full_matrices=False)
    idle = effects <= _TOLD * effects[0]
    if np.any(idle):
        which = [name for name, part in zip(names, np.abs(ways[idle]).max(axis=0), strict=True) if part > 0.1]
        remedy = "Fit fewer, or measure what they change."
        raise InvalidInput("fit: bounds", "must be of parameters that the measurements tell", which, remedy)
    return np.asarray((ways.T / effects**2) @ ways)


def _bounds(family: Family, bounds: Mapping[str, tuple[float, float]]) -> tuple[Floats, Floats]:
    for name, (low, high) in bounds.items():
        value = family[name]
        if not (is_finite(low) and is_finite(high) and low < high and low <= value <= high):
            remedy = f"The search begins at {value:.9g}."
            raise InvalidInput(f"fit: bounds of {name}", "must be a range around where it begins", (low, high), remedy)
    return np.array([low for low, _ in bounds.values()]), np.array([high for _, high in bounds.values()])
