"""Reading of files into tables, checks of tables, and changes of single values."""

from __future__ import annotations

import copy
import math
import tomllib
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import Any

from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.files import formats
from nonsmooth.files.components import TomlTable
from nonsmooth.storage.files import content_of


def parse(path: Path) -> TomlTable:
    """Tables of a file.

    Raises
    ------
    InvalidInput
        The file cannot be read, or its text is not of the format of its suffix.
    MissingPackagesError
        The format needs a package that is not installed.
    """
    form = formats.of(path)
    try:
        return form.parse(content_of(path).decode("utf-8"))
    except OSError as error:
        raise InvalidInput(
            "scenario file", "must be a file that can be read", str(path), f"{error.strerror}."
        ) from error
    except ValueError as error:
        raise InvalidInput(f"{path}", f"must be {form.name} text", str(error), "Correct the place it names.") from error
    except RecursionError as error:
        rule = f"must be {form.name} text whose tables and lists are in one another a few times"
        raise InvalidInput(f"{path}", rule, "hundreds of times", "No system needs so many.") from error


def changed(tables: TomlTable, changes: Mapping[str, Any], path: Path) -> TomlTable:
    """Copy of parsed TOML tables in which some values are replaced.

    ``changes`` maps dotted keys, such as "bodies.ball.radius", to new values. A number in a key is an index of an
    array, which counts from 0.

    Raises
    ------
    InvalidInput
        A key leads to a table or an element that does not exist.
    """
    made: Any = copy.deepcopy(tables)
    for key, one in changes.items():
        *way, last = key.split(".")
        place: Any = made
        for step in way:
            place = _inside(place, step, key, path)
        if isinstance(place, dict):
            place[last] = one
        else:
            _inside(place, last, key, path)
            place[int(last)] = one
    return dict(made)


def _inside(place: Any, step: str, key: str, path: Path) -> Any:
    items = enumerate(place) if isinstance(place, list) else place.items() if isinstance(place, dict) else ()
    known = {str(name): one for name, one in items}
    if step not in known:
        listing = ", ".join(known) or "nothing"
        raise InvalidInput(f"{key}", f"must be a key of {path}", step, f"Known there: {listing}.")
    return known[step]


def value(text: str) -> Any:
    """Value of a text as TOML; the text itself if it is not a TOML value."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except ValueError:
        return text


def check_keys(thing: str, table: Any, known: Collection[str], required: Sequence[str] = ()) -> None:
    """Raise InvalidInput if an object is not a table, a required key is missing, or a key is unknown."""
    if not isinstance(table, dict):
        raise InvalidInput(thing, "must be a table", table, f"Its keys are {', '.join(known)}.")
    for key in table:
        if key not in known:
            raise UnknownName(f"{thing}: key", key, known)
    for key in required:
        if key not in table:
            raise InvalidInput(f"{thing}: {key}", "must be given", None, "Add it; the page on scenario files has all.")


def tables_in(thing: str, value: Any) -> list[dict[str, Any]]:
    """Check an array of tables and return it; raise InvalidInput for anything else."""
    if not (isinstance(value, list) and all(isinstance(one, dict) for one in value)):
        raise InvalidInput(
            thing, "must be an array of tables", value, f"Write [[{thing.rpartition(' ')[2]}]] above each."
        )
    return value


def number(thing: str, value: Any, unit: str, positive: bool = False) -> float:
    """Check a finite number, and that it is positive if required; return it as a float or raise InvalidInput."""
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise InvalidInput(thing, "must be a finite number", value, f"Give it in [{unit}].")
    if positive and value <= 0.0:
        raise InvalidInput(thing, "must be positive", value, f"Give it in [{unit}].")
    return float(value)


def words(thing: str, value: Any, n: int | None = None) -> list[str]:
    """Check a list of names, with ``n`` names if that is given; return it or raise InvalidInput."""
    right = isinstance(value, list) and all(isinstance(one, str) for one in value)
    if not right or (n is not None and len(value) != n):
        count = "" if n is None else f"{n} "
        raise InvalidInput(thing, f"must be a list of {count}names", value, 'For example ["ball", "floor"].')
    return list(value)
