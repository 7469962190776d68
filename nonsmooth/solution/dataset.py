"""A solution as one dataset of xarray: what is on disk, but for the states of integrator and laws."""

from __future__ import annotations

from typing import TYPE_CHECKING

from nonsmooth.solution.variables import of_events, of_samples, of_system

if TYPE_CHECKING:
    import xarray

    from nonsmooth.solution.solution import Solution


def to_dataset(solution: Solution) -> xarray.Dataset:
    """Return samples and events of a solution as one dataset with units and labels."""
    import xarray

    samples = of_samples(solution.t, solution.q, solution.u)
    variables = [*of_system(solution.system), *samples, *of_events(solution.events)]
    return xarray.Dataset(
        {one.name: (one.dimensions, one.values, dict(one.attributes)) for one in variables},
        attrs=vars(solution.energy)
        | {
            "Conventions": "CF-1.11",
            "status": solution.status,
            "message": solution.message,
            "t_end": solution.t_end,
            "energy_residual": solution.energy.residual,
        },
    )
