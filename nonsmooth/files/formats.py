"""Formats of scenario files, chosen by the suffix of the name; each has a reader and a writer of the same tables."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

from nonsmooth.errors import InvalidInput
from nonsmooth.files import yaml_text


@final
@dataclass(frozen=True)
class FileFormat:
    """A format of scenario files.

    Attributes
    ----------
    name : str
        Name of the format.
    parse : callable
        Function from text to tables. It raises ValueError with the place of a mistake.
    write : callable
        Function from tables to text.
    """

    name: str
    parse: Callable[[str], dict[str, Any]]
    write: Callable[[dict[str, Any]], str]


_BARE = re.compile(r"[A-Za-z0-9_-]+")
_WIDTH = 100


def text_of(tables: Mapping[str, Any]) -> str:
    """TOML text of tables: plain values first, then a section for each table.

    A table that contains only tables, such as ``bodies``, becomes a section for each of them.

    Parameters
    ----------
    tables : mapping
        Numbers, strings, lists and mappings by name. Lists of mappings become arrays of tables.
    """
    plain = {key: value for key, value in tables.items() if not _is_section(value)}
    parts = ["\n".join(_line(key, value) for key, value in plain.items())] if plain else []
    for key, value in tables.items():
        if key in plain:
            continue
        if isinstance(value, Mapping) and value and all(isinstance(one, Mapping) for one in value.values()):
            parts += [_section(f"[{_key(key)}.{_key(name)}]", one) for name, one in value.items()]
        elif isinstance(value, Mapping):
            parts.append(_section(f"[{_key(key)}]", value))
        else:
            parts += [_section(f"[[{_key(key)}]]", one) for one in value]
    return "\n\n".join(parts) + "\n"


def _is_section(value: Any) -> bool:
    return isinstance(value, Mapping) or (
        isinstance(value, list) and bool(value) and all(isinstance(one, Mapping) for one in value)
    )


def _section(head: str, table: Mapping[str, Any]) -> str:
    return "\n".join([head, *(_line(key, value) for key, value in table.items())])


def _line(key: str, value: Any) -> str:
    line = f"{_key(key)} = {_inline(value)}"
    if isinstance(value, list) and len(line) > _WIDTH:
        return "\n".join([f"{_key(key)} = [", *(f"    {_inline(one)}," for one in value), "]"])
    return line


def _inline(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list):
        return f"[{', '.join(map(_inline, value))}]"
    pairs = [f"{_key(key)} = {_inline(one)}" for key, one in value.items()]
    return f"{{ {', '.join(pairs)} }}" if pairs else "{}"


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else _inline(name)


_TOML, _YAML = FileFormat("TOML", tomllib.loads, text_of), FileFormat("YAML", yaml_text.tables_of, yaml_text.text_of)
_FORMATS = {".toml": _TOML, ".yaml": _YAML, ".yml": _YAML}
SUFFIXES = tuple(_FORMATS)
"""Suffixes of scenario files."""


def of(path: Path) -> FileFormat:
    """Format of a file.

    Raises
    ------
    InvalidInput
        The name of the file has another suffix.
    """
    if path.suffix not in _FORMATS:
        remedy = "Scenario files are TOML or YAML; rename one that is: JSON text is YAML, too."
        raise InvalidInput("scenario file", f"must end in {', '.join(SUFFIXES)}", str(path), remedy)
    return _FORMATS[path.suffix]
