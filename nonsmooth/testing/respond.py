"""What an impact law of either kind makes of a problem."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.binding.compile import parameter_names
from nonsmooth.interfaces import ImpactLaw, ImpactMap, ImpactProcess
from nonsmooth.problems.impact import solve_impact
from nonsmooth.testing.callers import compiled_map
from nonsmooth.testing.reference import Constant, Problem

Array = NDArray[np.float64]
_TOLERANCE = 1e-11


@final
@dataclass(frozen=True)
class Response:
    """What came of it: velocities after, impulses [n, 3], gap rates and slip before and after [n, 3], energies."""

    velocity: Array
    impulse: Array
    before: Array
    after: Array
    stored: Array
    returned: Array

    @property
    def size(self) -> float:
        """Largest speed of the contacts before or after [m/s]."""
        return float(max(np.max(np.abs(self.before)), np.max(np.abs(self.after)), 1e-300))


def respond(laws: Sequence[ImpactLaw], frictions: Sequence[float], problem: Problem) -> Response:
    """Return what the laws, one per contact, make of a problem with these friction coefficients.

    Of a map the energies stay zero: it does not tell them.
    """
    columns, n = problem.columns, problem.n
    response = np.linalg.solve(problem.mass, columns)
    before = columns.T @ problem.velocity
    stored, returned = np.zeros(n), np.zeros(n)
    processes = [law for law in laws if isinstance(law, ImpactProcess)]
    if processes:
        result = solve_impact(
            problem.mass,
            problem.normal,
            problem.tangential,
            problem.velocity,
            processes,
            [Constant(mu) for mu in frictions],
            tolerance=_TOLERANCE,
        )
        impulse = np.column_stack([result.normal_impulse, result.tangential_impulse])
        stored, returned = result.stored, result.returned
    else:
        impulse = map_impulses(laws, frictions, columns.T @ response, before).reshape(n, 3)
    velocity = problem.velocity + response @ impulse.ravel()
    after = (columns.T @ velocity).reshape(n, 3)
    return Response(velocity, impulse, before.reshape(n, 3), after, stored, returned)


def vectors_of(laws: Sequence[ImpactLaw], frictions: Sequence[float]) -> dict[str, Array]:
    """Return the parameters that the function of a map may ask for, one number per contact."""
    names = laws[0].parameters()
    own = {name: np.array([float(law.numbers()[name]) for law in laws]) for name in names}
    return {"friction": np.array(frictions, dtype=float), **own}


def map_impulses(laws: Sequence[ImpactLaw], frictions: Sequence[float], delassus: Array, rates: Array) -> Array:
    """Return the impulses of laws that are maps, shape [3 n]."""
    law = laws[0]
    assert isinstance(law, ImpactMap)
    offered = vectors_of(laws, frictions)
    vectors = {name: offered[name] for name in parameter_names(law.impulses, "map")}
    out = np.zeros(len(rates))
    call = compiled_map(law.impulses, vectors, type(law).__name__)
    call(len(laws), np.ascontiguousarray(delassus).ravel(), np.array(rates, dtype=float), out)
    return out
