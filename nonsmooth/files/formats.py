"""The formats of scenario files, by what a file's name ends in: each a reader and a writer of the same tables."""

from __future__ import annotations

import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

from nonsmooth.errors import InvalidInput
from nonsmooth.files import text, yaml_text


@final
@dataclass(frozen=True)
class Format:
    """A format.

    Attributes
    ----------
    name : str
        What it is called.
    parse : callable
        From text to tables; raises ValueError with the place where it is wrong.
    write : callable
        From tables to text.
    """

    name: str
    parse: Callable[[str], dict[str, Any]]
    write: Callable[[dict[str, Any]], str]


_TOML, _YAML = Format("TOML", tomllib.loads, text.text_of), Format("YAML", yaml_text.tables_of, yaml_text.text_of)
_FORMATS = {".toml": _TOML, ".yaml": _YAML, ".yml": _YAML}
SUFFIXES = tuple(_FORMATS)
"""What the name of a scenario file ends in."""


def of(path: Path) -> Format:
    """Return the format of a file.

    Raises
    ------
    InvalidInput
        If its name ends in none of those known.
    """
    if path.suffix not in _FORMATS:
        remedy = "Scenario files are TOML or YAML; rename one that is: JSON text is YAML, too."
        raise InvalidInput("scenario file", f"must end in {', '.join(SUFFIXES)}", str(path), remedy)
    return _FORMATS[path.suffix]
