"""Basins of attraction: shares of the starts that lead to each attractor, and uncertainty of the boundaries."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.studies.attractors.labels import runs_by_value, words_of
from nonsmooth.types import Array

if TYPE_CHECKING:
    import xarray

_MARGIN = 8
"""Least ratio of the shortest side of the grid to the largest distance between a start and its neighbour.  Starts
nearer to an edge than this distance are left out; at a ratio of 8, three quarters of the side remain."""
_FEWEST = 3
"""Least number of distances in the fit of the uncertainty exponent: a standard error needs a third point."""
_SMOOTH = 1.0
"""Uncertainty exponent of a smooth boundary, the largest possible value."""
_SATURATED = 0.5
"""Largest share of starts with a neighbour on another attractor, for a distance between neighbours to enter the fit.
Above it, this distance is not small compared with the basins."""


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
        If the array has no names of attractors (``flag_meanings``), or no run reached its end.

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
        Number of equal intervals of the parameter's range, into which values drawn at random are sorted.  In a grid,
        the share is computed for each value.

    Returns
    -------
    Dataset
        ``share`` b and its standard ``error`` sqrt(b (1 - b) / N), over the attractors and the parameter.  ``runs`` N,
        the number of runs that reached their end, over the parameter.  Share and error are nan if N is 0.

    Raises
    ------
    InvalidInput
        If the array has no names of attractors (``flag_meanings``), or `bins` is not positive.
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


@final
@dataclass(frozen=True, eq=False)
class Boundary:
    """Uncertainty of basin boundaries: share f of uncertain starts over the distance eps, f ~ eps^exponent.

    Attributes
    ----------
    steps : array
        Distances eps, in steps of the grid, shape [n].
    uncertain : array
        Share f of uncertain starts at each distance, shape [n].  A start is uncertain if a neighbour at this distance,
        along an axis of the grid, leads to another attractor.
    starts : int
        Number of starts whose neighbours all exist and reached their end.
    exponent, error : float
        Uncertainty exponent, 1 for a smooth boundary, and its standard error from the scatter about the fit.  No
        boundary has an exponent above 1, so the error is at least the excess of the exponent over 1.
    offset : float
        Value of ln f on the fitted line at a distance of one step.
    dimension : float
        Dimension of the boundary: dimension of the grid less the exponent; an exponent above 1 is taken as 1.
    """

    steps: Array
    uncertain: Array
    starts: int
    exponent: float
    error: float
    offset: float
    dimension: float


def uncertainty_exponent(attractor: xarray.DataArray) -> Boundary:
    """Return the uncertainty exponent of the boundaries between all attractors of a grid of starts.

    A start is uncertain at a distance eps if a neighbour at this distance, along an axis of the grid, leads to another
    attractor.  Distances are 1, 2, 4 ... steps of the grid, up to an eighth of its shortest side.  A start is used if
    it has neighbours at all distances, and its run and the runs of these neighbours reached their end.  With f as the
    share of uncertain starts, the exponent is the slope of ln f over ln eps by least squares.  The fit uses only
    distances with f up to 1/2.

    Parameters
    ----------
    attractor : DataArray
        The attractors of a study over a grid of evenly spaced starts.  If the study also varies a parameter, choose one
        value of it: ``attractor.sel(gamma=0.8)``.

    Raises
    ------
    InvalidInput
        If the array has no names of attractors (``flag_meanings``), or the grid is uneven, too small, or without a
        boundary.

    References
    ----------
    S. W. McDonald, C. Grebogi, E. Ott, J. A. Yorke, "Fractal basin boundaries", Physica D 17 (1985) 125-153.
    """
    from scipy.stats import linregress

    words_of(attractor, "uncertainty_exponent")
    _check_even(attractor)
    labels = attractor.values
    steps = 2 ** np.arange(int(np.log2(max(min(labels.shape) // _MARGIN, 1))) + 1)
    if len(steps) < _FEWEST:
        remedy = f"Take {_MARGIN * 2 ** (_FEWEST - 1)} values of each parameter, or more."
        raise InvalidInput("uncertainty_exponent", "needs a larger grid", labels.shape, remedy)
    found = [_neighbours(labels, int(step), int(steps[-1])) for step in steps]
    known = np.all([whole for whole, _ in found], axis=0)
    uncertain = np.array([other[known].mean() if known.any() else 0.0 for _, other in found])
    if not uncertain.any():
        rule = "needs starts next to which others lead to another attractor"
        raise InvalidInput("uncertainty_exponent", rule, uncertain.tolist(), "Draw the map: is there a boundary?")
    fitted = (uncertain > 0.0) & (uncertain <= _SATURATED)
    if fitted.sum() < _FEWEST:
        rule = f"needs {_FEWEST} distances at which at most half of the starts have another attractor"
        raise InvalidInput("uncertainty_exponent", rule, uncertain.tolist(), "Take a finer grid.")
    fit = linregress(np.log(steps[fitted]), np.log(uncertain[fitted]))
    exponent = float(fit.slope)
    # no boundary has an exponent above 1: the excess is an error of the fit
    error = max(float(fit.stderr), exponent - _SMOOTH)
    n_starts, offset, dimension = int(known.sum()), float(fit.intercept), labels.ndim - min(exponent, _SMOOTH)
    return Boundary(steps.astype(float), uncertain, n_starts, exponent, error, offset, dimension)


def _check_even(attractor: xarray.DataArray) -> None:
    for name in attractor.dims:
        values = attractor[name].values
        gaps = np.diff(values) if name in attractor.coords and values.dtype.kind == "f" else np.zeros(0)
        if not len(gaps) or not np.allclose(gaps, gaps.mean(), rtol=1e-6, atol=0.0):
            remedy = "Vary numbers evenly by studies.grid; of a further parameter choose one value."
            raise InvalidInput("uncertainty_exponent", "must be over an even grid", str(name), remedy)


def _neighbours(labels: NDArray[np.int64], step: int, margin: int) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Compare each start at least ``margin`` from the edges of a grid with its neighbours; return two masks.

    The neighbours of a start are ``step`` grid steps away along each axis, in both directions.  The first mask is True
    if the start and all its neighbours lead to known attractors.  The second mask is True if at least one neighbour
    leads to another attractor than the start.
    """
    inner = tuple(slice(margin, n - margin) for n in labels.shape)
    known, other = labels[inner] >= 0, np.zeros(labels[inner].shape, bool)
    for axis in range(labels.ndim):
        for way in (-step, step):
            there = np.roll(labels, way, axis)[inner]
            known &= there >= 0
            other |= there != labels[inner]
    return known, other
