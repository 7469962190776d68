"""Files to tables, and changes of single values."""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from nonsmooth.errors import InvalidInput
from nonsmooth.files import formats
from nonsmooth.files.components import Table
from nonsmooth.storage.files import content_of


def parse(path: Path) -> Table:
    """Return the tables of a file.

    Raises
    ------
    InvalidInput
        If it cannot be read or is no text of the format that its name ends in.
    MissingPackagesError
        If its format needs a package that is not installed.
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


def changed(tables: Table, changes: Mapping[str, Any], path: Path) -> Table:
    """Return the tables with the values at some dotted keys replaced; numbers count through arrays, from 0.

    Raises
    ------
    InvalidInput
        If a key leads nowhere.
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
    """Return what a text means as a TOML value, itself where it means none."""
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except ValueError:
        return text
