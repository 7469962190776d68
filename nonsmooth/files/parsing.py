"""TOML text to tables, and changes of single values."""

from __future__ import annotations

import copy
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from nonsmooth.errors import InvalidInput
from nonsmooth.files.components import Table

if sys.version_info >= (3, 11):
    from tomllib import TOMLDecodeError, loads
else:
    from nonsmooth.files.toml import TOMLDecodeError, loads


def parse(path: Path) -> Table:
    """Return the tables of a file.

    Raises
    ------
    InvalidInput
        If it cannot be read or is no TOML.
    """
    try:
        return loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise InvalidInput(
            "scenario file", "must be a file that can be read", str(path), f"{error.strerror}."
        ) from error
    except (TOMLDecodeError, UnicodeDecodeError) as error:
        raise InvalidInput(f"{path}", "must be TOML text", str(error), "Correct the place it names.") from error


def changed(tables: Table, changes: Mapping[str, str], path: Path) -> Table:
    """Return the tables with the values at some dotted keys replaced; numbers count through arrays of tables, from 0.

    Raises
    ------
    InvalidInput
        If a key leads nowhere.
    """
    made: Any = copy.deepcopy(tables)
    for key, text in changes.items():
        *way, last = key.split(".")
        place: Any = made
        for step in way:
            place = _inside(place, step, key, path)
        if isinstance(place, dict):
            place[last] = value(text)
        else:
            _inside(place, last, key, path)
            place[int(last)] = value(text)
    return dict(made)


def _inside(place: Any, step: str, key: str, path: Path) -> Any:
    items = enumerate(place) if isinstance(place, list) else place.items() if isinstance(place, dict) else ()
    known = {str(name): one for name, one in items}
    if step not in known:
        listing = ", ".join(known) or "nothing"
        raise InvalidInput(f"--set {key}", f"must be a key of {path}", step, f"Known there: {listing}.")
    return known[step]


def value(text: str) -> Any:
    """Return what a text means as a TOML value, itself where it means none."""
    try:
        return loads(f"value = {text}")["value"]
    except TOMLDecodeError:
        return text
