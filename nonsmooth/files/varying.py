"""The numbers of a file, by their dotted keys, and what is known of them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from nonsmooth.files.components import TYPE, Table, group_of, hints_of
from nonsmooth.files.gate import Gate
from nonsmooth.parameters import Component, Rule, rules
from nonsmooth.plugins import registry

_GROUPS = {"contacts": "laws", "materials": "laws", "engine": "engines"}
"""Where classes of the components of a section are listed, if not under its own name."""
_UNITS = {"t_end": "s", "sample_interval": "s", "gravity": "m/s^2"}
_UNKNOWN = "SI"
"""Unit of what is no parameter of a class, as the words of a start: they are in SI units."""


def numbers(tables: Table, gate: Gate) -> dict[str, tuple[float, Rule]]:
    """Return all numbers by dotted key, "bodies.ball.radius", and what is known of each.

    Elements of arrays count from 0; the gate says what classes the names mean.
    """
    return dict(_numbers(tables, (), None, gate))


def _numbers(
    place: Any, way: tuple[str, ...], rule: Rule | None, gate: Gate, group: str = ""
) -> Iterator[tuple[str, tuple[float, Rule]]]:
    """Walk through tables; ``group`` lists the classes of the components that are looked for, "" where none are."""
    if isinstance(place, dict):
        owner = _class(place, group, gate)
        declared: Mapping[str, Any] = {} if owner is None else rules(owner)
        hints: Mapping[str, Any] = {} if owner is None else hints_of(owner)
        for name, one in place.items():
            section = group if way else _GROUPS.get(str(name), str(name))
            inner = section if owner is None else group_of(hints.get(name))
            known = declared[name][1] if name in declared else None
            yield from _numbers(one, (*way, name), known, gate, inner)
    elif isinstance(place, list):
        for i, one in enumerate(place):
            yield from _numbers(one, (*way, str(i)), rule, gate, group)
    elif isinstance(place, (int, float)) and not isinstance(place, bool):
        key = ".".join(way)
        yield key, (place, rule or Rule(key, _UNITS.get(way[0], _UNKNOWN)))


def _class(table: Table, group: str, gate: Gate) -> Any:
    """Return the class that the table of a component names, None where it is no such table."""
    word = table.get(TYPE)
    if group not in registry.GROUPS or not isinstance(word, str):
        return None
    return gate.component(TYPE, group, Component, word)
