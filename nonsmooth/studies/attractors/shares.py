"""Shares of the starts that lead to each attractor: basin stability, and its change along a parameter."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.studies.attractors.labels import runs_by_value, words_of

if TYPE_CHECKING:
    import xarray


def basin_stability(attractor: xarray.DataArray) -> dict[str, tuple[float, float]]:
    """Return the share b of the starts that lead to each attractor, and its standard error sqrt(b (1 - b) / N).

    Parameters
    ----------
    attractor : DataArray
        The attractors of a study whose starts were drawn from the volume of interest; N counts the runs that reached
        their end.

    Raises
    ------
    InvalidInput
        If it is no record of words, or no run reached its end.

    References
    ----------
    P. J. Menck, J. Heitzig, N. Marwan, J. Kurths, "How basin stability complements the linear-stability paradigm",
    Nature Physics 9 (2013) 89-92.
    """
    words, values = words_of(attractor, "basin_stability"), attractor.values.ravel()
    n = int((values >= 0).sum())
    if n == 0:
        raise InvalidInput("basin_stability", "needs runs that came to their end", n, "See `status` and `reason`.")
    shares = {word: float((values == i).sum()) / n for i, word in enumerate(words)}
    return {word: (b, math.sqrt(b * (1.0 - b) / n)) for word, b in shares.items()}


def basin_fractions(attractor: xarray.DataArray, parameter: str, bins: int = 10) -> xarray.Dataset:
    """Return the share of the starts that lead to each attractor, for each value of a parameter.

    Parameters
    ----------
    attractor : DataArray
        The attractors of a study.
    parameter : str
        A parameter that the study varies.
    bins : int
        Parts of its range if the runs are draws; of a grid each value counts.

    Returns
    -------
    Dataset
        Over the attractors and the parameter ``share`` b and its standard ``error`` sqrt(b (1 - b) / N); over the
        parameter ``runs`` N, those that reached their end.  Without such runs the share is nan.

    Raises
    ------
    InvalidInput
        If it is no record of words.
    UnknownName
        If the study does not vary the parameter.
    """
    import xarray

    words, values = words_of(attractor, "basin_fractions"), attractor.values.ravel()
    split = runs_by_value(attractor, parameter, bins)
    counts = np.zeros((len(words), len(split.values)))
    np.add.at(counts, (values[values >= 0], split.of_runs[values >= 0]), 1.0)
    runs = counts.sum(axis=0)
    share = counts / np.where(runs > 0.0, runs, np.nan)
    over = "attractor", parameter
    return xarray.Dataset(
        {
            "share": (over, share, {"long_name": "share of the starts", "units": "1"}),
            "error": (over, np.sqrt(share * (1.0 - share) / runs), {"long_name": "standard error", "units": "1"}),
            "runs": (parameter, runs.astype(int), {"long_name": "runs that came to their end", "units": "1"}),
        },
        {"attractor": list(words), parameter: (parameter, split.values, attractor[parameter].attrs)},
    )
