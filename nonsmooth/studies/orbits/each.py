"""A system with each value of a parameter, run one after another: what fails is told, and the rest goes on."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeVar

from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.progress import Display, Pace, RunsDone
from nonsmooth.runs.model import Model
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.displays import display_of

Found = TypeVar("Found")


def of_each(
    family: Family,
    name: str,
    values: Sequence[float],
    find: Callable[[Model, float], Found],
    nothing: Found,
    display: Display | None,
) -> tuple[list[Found], tuple[str, ...]]:
    """Return what is found with each value of a parameter, and why there is nothing, "" where there is.

    Parameters
    ----------
    family : Family
        The systems.
    name : str
        The parameter.
    values : sequence of float
        Its values.
    find : callable
        ``find(model, value)`` runs the model of a value; it may raise RunFailed or InvalidInput.
    nothing : object
        What stands where it does.
    display : Display, optional
        Where progress is shown; on standard error by default.

    Raises
    ------
    UnknownName
        If there is no such parameter.
    InvalidInput
        If no value makes a system.
    """
    _ = family[name]
    if not len(values):
        raise InvalidInput(f"values of {name}", "must be some", list(values), "Give at least one.")
    found, failures, refused = list[Found](), list[str](), list[InvalidInput]()
    with Pace(display_of(display)) as pace:
        counted = RunsDone(pace, len(values))
        for value in values:
            try:
                found.append(find(family.model(**{name: value}), value))
                failures.append("")
            except (RunFailed, InvalidInput) as error:
                found.append(nothing)
                failures.append(str(error))
                refused += [error] if isinstance(error, InvalidInput) else []
            counted.add(1, bool(failures[-1]))
    if len(refused) == len(values):
        raise refused[0]
    return found, tuple(failures)
