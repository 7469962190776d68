"""Tables of text: aligned columns, and the rows of the parameters of a class."""

from __future__ import annotations

import dataclasses
import textwrap
from collections.abc import Sequence
from typing import Any

from nonsmooth.parameters import Rule

HEAD = ("parameter", "default", "unit", "allowed", "meaning")
ASSUMED = "* assumed: the source does not give this value, we chose it"
_WIDTH = 80
"""Width of a line [characters]."""


def lines(rows: Sequence[Sequence[str]], indent: str = "  ") -> list[str]:
    """Return rows of cells as lines with aligned columns."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    padded = (indent + "  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True)) for row in rows)
    return [line.rstrip() for line in padded]


def folded(rows: Sequence[Sequence[str]], indent: str = "  ") -> list[str]:
    """Return rows of cells as aligned lines, with the last column folded to lines of 80 characters."""
    if not rows:
        return []
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    found = []
    for *cells, text in rows:
        head = indent + "".join(f"{cell.ljust(w)}  " for cell, w in zip(cells, widths, strict=False))
        fold = textwrap.TextWrapper(
            _WIDTH,
            initial_indent=head,
            subsequent_indent=" " * len(head),
            break_long_words=False,
            break_on_hyphens=False,
        )
        found += fold.wrap(text) or [head.rstrip()]
    return found


def parameter_rows(owner: Any) -> list[tuple[str, str, str, str, str]]:
    """Return name, default, unit, allowed range and description of each field in a dataclass's constructor."""
    return [_row(field) for field in dataclasses.fields(owner) if field.init]


def _row(field: dataclasses.Field[Any]) -> tuple[str, str, str, str, str]:
    rule = field.metadata.get("rule")
    if rule is None:
        return field.name, _default(field), "", f"a {field.type}", "from Python or a scenario file"
    return field.name, _default(field) + " *" * rule.assumed, rule.unit, _allowed(field, rule), rule.doc


def _allowed(field: dataclasses.Field[Any], rule: Rule) -> str:
    if rule.unit == "" and not rule.choices:
        return "numbers apart by colons" if isinstance(field.default, tuple) else "a name"
    return rule.describe()


def _default(field: dataclasses.Field[Any]) -> str:
    if field.default_factory is not dataclasses.MISSING:
        return repr(field.default_factory())
    if field.default is dataclasses.MISSING:
        return "required"
    return "-" if field.default is None else str(field.default)
