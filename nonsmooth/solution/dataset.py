"""A solution as one dataset of xarray: what is on disk, but for the states of integrator and laws."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from nonsmooth.solution.solution import Solution
from nonsmooth.solution.variables import of_events, of_samples, of_system

if TYPE_CHECKING:
    import xarray

_NONE: Mapping[str, Any] = MappingProxyType({})


def to_dataset(solution: Solution, coordinates: Mapping[str, Any] = _NONE) -> xarray.Dataset:
    """Return samples and events of a solution as one dataset with units and labels.

    ``coordinates`` are further variables over the samples, as a scenario gives them: name -> array [n_samples].
    """
    import xarray

    samples = of_samples(solution.t, solution.q, solution.u)
    variables = [*of_system(solution.system), *samples, *of_events(solution.events)]
    return xarray.Dataset(
        {one.name: (one.dimensions, one.values, dict(one.attributes)) for one in variables}
        | {name: (("time",), values, {"units": "SI"}) for name, values in coordinates.items()},
        attrs=vars(solution.energy)
        | {
            "Conventions": "CF-1.11",
            "status": solution.status,
            "message": solution.message,
            "t_end": solution.t_end,
            "energy_residual": solution.energy.residual,
        },
    )
