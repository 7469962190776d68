"""Sampling: the parameters of all runs of a study, from grids, lists and draws, fixed before any of them runs."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.checks import check_count, check_pair, is_finite
from nonsmooth.errors import InvalidInput
from nonsmooth.types import Array

Value: TypeAlias = float | str
Range: TypeAlias = tuple[float, float]
"""Lower end, which is included, and upper end, which is not."""
_STORED = {"i": "int64", "u": "uint64", "f": "float64", "U": "U"}
"""Type in which values are stored, by the kind of their numpy type."""


@final
@dataclass(frozen=True, eq=False)
class Sampling:
    """The parameters of all runs; :func:`grid`, :func:`random` and the like make them.

    Attributes
    ----------
    columns : mapping
        Values of each varied parameter, finite numbers or words, shape [n].
    description : mapping
        Kind and arguments of the sampling, as JSON types.
    dims : mapping
        Length of each axis of a grid, in C order; empty for other samplings.
    """

    columns: Mapping[str, NDArray[Any]]
    description: Mapping[str, Any]
    dims: Mapping[str, int] = field(default_factory=dict)

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def at(self, run: int) -> dict[str, Value]:
        """Return the parameters of a run."""
        return {name: column[run].item() for name, column in self.columns.items()}

    @property
    def digest(self) -> str:
        """Digest of all values, to the last bit (sha256)."""
        found = hashlib.sha256()
        for name, column in self.columns.items():
            found.update(f"{name} {column.dtype.str} ".encode() + np.ascontiguousarray(column).tobytes())
        return found.hexdigest()


def grid(**axes: ArrayLike) -> Sampling:
    """Return all combinations of values, the last parameter varies fastest.

    Parameters
    ----------
    **axes : array
        Values of each parameter, numbers or words, shape [n].

    Raises
    ------
    InvalidInput
        If no parameter is given, or its values are empty, repeated or not finite.
    """
    if not axes:
        raise InvalidInput("grid", "must vary a parameter at least", axes, "For example grid(restitution=[0.5, 0.9]).")
    found = {name: _column(name, values) for name, values in axes.items()}
    for name, values in found.items():
        unique, counts = np.unique(values, return_counts=True)
        if len(unique) < len(values):
            twice = unique[counts > 1][0].item()
            raise InvalidInput(f"study: {name}", "must have each value once", twice, "Leave out the others.")
    dims = {name: len(values) for name, values in found.items()}
    places = np.unravel_index(np.arange(int(np.prod(list(dims.values())))), list(dims.values()))
    columns = {name: found[name][at] for name, at in zip(found, places, strict=True)}
    return Sampling(columns, {"kind": "grid", "axes": dims}, dims)


def listed(rows: Iterable[Mapping[str, Value]]) -> Sampling:
    """Return runs that are listed one by one.

    Parameters
    ----------
    rows : iterable of dict
        Parameters of each run; all have the same names.

    Raises
    ------
    InvalidInput
        If there is no row, rows have different names, or a value is not finite.
    """
    all_rows = [dict(row) for row in rows]
    names = list(all_rows[0]) if all_rows else []
    for number, row in enumerate(all_rows):
        if set(row) != set(names):
            thing = f"listed: row {number}"
            raise InvalidInput(thing, f"must have the names {', '.join(names)}", sorted(row), "Complete it.")
    return columns({name: [row[name] for row in all_rows] for name in names})


def columns(table: Any) -> Sampling:
    """Return the rows of a table as runs.

    Parameters
    ----------
    table : mapping, or DataFrame
        Columns of equal length, by the names of the parameters.

    Raises
    ------
    InvalidInput
        If there is no column, lengths differ, or a value is not finite.
    """
    found = {str(name): _column(str(name), table[name]) for name in table}
    lengths = {name: len(values) for name, values in found.items()}
    if len(set(lengths.values())) != 1:
        rule = "must have columns, all of one length"
        raise InvalidInput("study: table", rule, lengths, 'For example listed([{"restitution": 0.5}]).')
    return Sampling(found, {"kind": "listed", "names": list(found)})


def random(n: int, seed: int = 0, /, **ranges: Range) -> Sampling:
    """Return independent, uniform draws from ranges; a longer study begins with the draws of a shorter one.

    Parameters
    ----------
    n : int
        Number of draws.
    seed : int
        Seed of the draws.
    **ranges : tuple of float
        Lower and upper end of each parameter.

    Raises
    ------
    InvalidInput
        If no range is given, or a range is empty or not finite.
    """

    def unit(d: int) -> Array:
        seeds = (np.random.SeedSequence(seed, spawn_key=(run,)) for run in range(n))
        return np.array([np.random.default_rng(one).random(d) for one in seeds])

    return _drawn("random", n, seed, ranges, unit)


def sobol(n: int, seed: int = 0, /, **ranges: Range) -> Sampling:
    """Return scrambled points of Sobol's sequence in ranges; ``n`` must be a power of two.

    Parameters and errors are those of :func:`random`.
    """

    def unit(d: int) -> Array:
        from scipy.stats import qmc

        if n & (n - 1):
            below = 1 << (n.bit_length() - 1)
            remedy = f"Take {below} or {2 * below}: other numbers spoil the balance of the sequence."
            raise InvalidInput("sobol: n", "must be a power of two", n, remedy)
        return np.asarray(qmc.Sobol(d, rng=np.random.default_rng(seed)).random(n))

    return _drawn("sobol", n, seed, ranges, unit)


def latin_hypercube(n: int, seed: int = 0, /, **ranges: Range) -> Sampling:
    """Return a Latin hypercube in ranges: each of ``n`` equal parts of every range has one run.

    Parameters and errors are those of :func:`random`.
    """

    def unit(d: int) -> Array:
        from scipy.stats import qmc

        return np.asarray(qmc.LatinHypercube(d, rng=np.random.default_rng(seed)).random(n))

    return _drawn("latin_hypercube", n, seed, ranges, unit)


def _drawn(kind: str, n: int, seed: int, ranges: Mapping[str, Range], unit: Callable[[int], Array]) -> Sampling:
    """Return draws from ranges.

    ``unit(d)`` returns n points of the unit cube in d dimensions, shape [n, d]; each column is scaled to the range of
    its parameter.
    """
    for name, value, least in (("n", n, 1), ("seed", seed, 0)):
        rule = f"must be a whole number from {least} on"
        check_count(f"{kind}: {name}", value, rule, f"For example {kind}(1024, 1, ...).", least)
    if not ranges:
        remedy = f"For example {kind}(1024, 1, restitution=(0.5, 0.9))."
        raise InvalidInput(kind, "must vary a parameter at least", dict(ranges), remedy)
    for name, ends in ranges.items():
        check_pair(f"study: {name}", ends)
        if not (is_finite(ends[0]) and is_finite(ends[1]) and ends[0] < ends[1]):
            rule = "must be a range of two finite numbers, the lower one first"
            raise InvalidInput(f"study: {name}", rule, ends, "For example (0.5, 0.9).")
    rows = zip(unit(len(ranges)).T, ranges.items(), strict=True)
    columns = {name: low + (high - low) * part for part, (name, (low, high)) in rows}
    described = {name: [float(end) for end in ends] for name, ends in ranges.items()}
    return Sampling(columns, {"kind": kind, "n": n, "seed": seed, "ranges": described})


def _column(name: str, values: Any) -> NDArray[Any]:
    """Return the values of a parameter as numbers or words; whole numbers such as seeds stay whole."""
    thing = f"study: {name}"
    rule, remedy = "must be a row of numbers or of words", "Give a list of them."
    try:
        found = np.asarray(values)
    except ValueError as error:
        raise InvalidInput(thing, rule, values, remedy) from error
    if found.ndim != 1 or found.dtype.kind not in "iufU":
        raise InvalidInput(thing, rule, values, remedy)
    if len(found) == 0:
        raise InvalidInput(thing, "must have a value at least", values, "Give one value or more.")
    if found.dtype.kind == "f" and not np.isfinite(found).all():
        bad = found[~np.isfinite(found)][0].item()
        raise InvalidInput(thing, "must have finite values", bad, "Leave out what is not a number.")
    return found.astype(_STORED[found.dtype.kind], copy=False)
