"""Tables as TOML text; floats as Python writes them, so that they come back to the last bit."""

from __future__ import annotations

import json
import re
from collections.abc import Mapping
from typing import Any

_BARE = re.compile(r"[A-Za-z0-9_-]+")
_WIDTH = 100


def text_of(tables: Mapping[str, Any]) -> str:
    """Return TOML text: plain values first, then a section for every table, and for every table of a table of tables.

    Parameters
    ----------
    tables : mapping
        Numbers, words, lists and mappings by name.  Lists of mappings become arrays of tables.
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
