"""Reading of histories: evaluates the requested variables in as few passes over the run as possible."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.histories.history import FIXED_LABELS, History, LabelledArray
from nonsmooth.histories.request import HistoryRequest, Parts, numbers_of, read_times
from nonsmooth.histories.variables import VARIABLES, Variable
from nonsmooth.system.names import labels

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

_WHERE = "Solution.history"
_KINDS = {"contact": "contact", "frame": "body", "coordinate": "body", "velocity": "body", "joint": "joint"}
"""Name of an axis of a history -> kind of the parts of the system over which the axis runs."""


def read_history(
    solution: Solution,
    names: Sequence[str | Variable],
    times: ArrayLike | None = None,
    of: Parts | None = None,
) -> History:
    """History of variables of a run (:meth:`nonsmooth.Solution.history`)."""
    rows = [_row(name) for name in names]
    if not rows:
        raise InvalidInput(f"{_WHERE}: names", "must be at least one", (), f"Known: {', '.join(VARIABLES)}.")
    if len({row.name for row in rows}) < len(rows):
        raise InvalidInput(f"{_WHERE}: names", "must differ", [row.name for row in rows], "Ask for each name once.")
    if len(over := {row.over for row in rows}) > 1:
        rule = "must be variables over time, or variables over impulses"
        raise InvalidInput(f"{_WHERE}: names", rule, [row.name for row in rows], "Ask for each kind in its own call.")
    if over == {"impulse"} and times is not None:
        raise InvalidInput(f"{_WHERE}: times", "must be left out", times, "Impulses have the times of their events.")
    given = read_times(_WHERE, solution, times)
    kinds = list(dict.fromkeys(_KINDS[axis] for row in rows for axis in row.axes if axis in _KINDS))
    request = HistoryRequest(solution, np.atleast_1d(given), numbers_of(f"{_WHERE}: of", solution.system, kinds, of))
    readings: dict[Any, Any] = {}
    for row in rows:
        if row.reading not in readings:
            readings[row.reading] = row.reading(request)
    time = readings[rows[0].reading].time if over == {"impulse"} else request.times
    names_along, along = _names(request, {axis for row in rows for axis in row.axes})
    sizes = {axis: len(found) for axis, found in (*FIXED_LABELS.items(), *names_along.items())}
    sizes |= {"time": len(time), "impulse": len(time)}
    single = given.ndim == 0 and over == {"time"}
    arrays = tuple(_labelled(row, row.values(readings[row.reading]), sizes, single) for row in rows)
    if over == {"impulse"}:
        return History.of(time, arrays, {}, over="impulse")
    return History.of(given, arrays, names_along, along=along)


def _row(name: str | Variable) -> Variable:
    if isinstance(name, Variable):
        if VARIABLES.get(name.name, name) is not name:
            raise InvalidInput(f"{_WHERE}: variable", "must have a name of its own", name.name, "Choose another name.")
        return name
    if not isinstance(name, str) or name not in VARIABLES:
        remedy = "print(nonsmooth.histories.variables.variables()) lists them; a variable of your own is an object."
        raise UnknownName(f"{_WHERE}: variable", str(name), VARIABLES, remedy=remedy)
    return VARIABLES[name]


def _labelled(row: Variable, values: ArrayLike, sizes: Mapping[str, int], single: bool) -> LabelledArray:
    """Labelled array of a variable (a row of the table of variables); without the axis of time for a single time.

    Raises
    ------
    InvalidInput
        The function of the row returns an array with other axes, or with other lengths of axes of known size.
    """
    values, axes = np.asarray(values), (row.over, *row.axes)
    wanted = [sizes.get(axis) for axis in axes]
    if len(wanted) != values.ndim or any(n not in (None, m) for n, m in zip(wanted, values.shape, strict=True)):
        rule = f"must have the axes {', '.join(f'{axis} ({sizes[axis]})' if axis in sizes else axis for axis in axes)}"
        remedy = "Entries of closed contacts become an array over times and contacts by `spread`."
        raise InvalidInput(f"values of the variable {row.name!r}", rule, values.shape, remedy)
    return LabelledArray.of(row.name, row.axes, values[0] if single else values, row.description, row.unit)


def _names(request: HistoryRequest, axes: set[str]) -> tuple[dict[str, tuple[str, ...]], tuple[LabelledArray, ...]]:
    """Names along the axes, and the units of coordinates and velocities."""
    system, names = request.solution.system, request.solution.system.names
    found: dict[str, tuple[str, ...]] = {}
    if "contact" in axes:
        found["contact"] = tuple(names.contacts[number] for number in request.numbers("contact"))
    if "joint" in axes:
        found["joint"] = tuple(names.joints[number] for number in request.numbers("joint"))
    if "frame" in axes:
        found["frame"] = tuple(
            names.bodies[number] + (f" frame {frame}" if n_frames > 1 else "")
            for number in request.numbers("body")
            for n_frames in [len(system.bodies[number].frames)]
            for frame in range(n_frames)
        )
    along = []
    for axis, known, size in (("coordinate", "coordinates", "n_q"), ("velocity", "velocities", "n_u")):
        if axis in axes:
            every = getattr(labels(system), known)
            rows = [every[column] for column in request.columns(size)]
            found[axis] = tuple(name for _, name, _ in rows)
            units = np.array([unit for *_, unit in rows], dtype=str)
            along.append(LabelledArray.of(f"{axis}_units", (axis,), units, f"unit of the {axis}"))
    return found, tuple(along)
