"""Rows of words for the parameters of a class, in the terminal and on the pages of the reference."""

from __future__ import annotations

import dataclasses
from typing import Any

from nonsmooth.parameters import Rule

HEAD = ("parameter", "default", "unit", "allowed", "")
ASSUMED = "* assumed: the source does not give this value, we chose it"


def parameter_rows(owner: Any) -> list[tuple[str, str, str, str, str]]:
    """Return name, default, unit, allowed range and meaning of each field of a dataclass that its call takes."""
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
