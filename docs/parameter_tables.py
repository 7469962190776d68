"""Fields are declared by calls of ``parameter``: show their defaults in signatures, and the rest as a table.

Helpers make some of these calls, so the classes are imported; the words are those of ``nonsmooth show``.
"""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Iterator, Sequence
from typing import Any

import griffe

from nonsmooth.cli.report.table import ASSUMED, HEAD, parameter_rows
from nonsmooth.parameters import rules

_SECTION = re.compile(r"^\w[\w ]*\n-{3,}$", re.MULTILINE)
"""The heading of a numpy docstring's first section, before which its text ends."""


class ParameterTables(griffe.Extension):
    """Gives classes that have parameters their defaults and their table."""

    def on_package(self, *, pkg: griffe.Module, **_: Any) -> None:
        """Look at every dataclass of a package, before signatures are made of their fields."""
        for cls in _dataclasses(pkg):
            owner = griffe.dynamic_import(cls.path)
            for name, (field, _rule) in rules(owner).items():
                if name in cls.members:
                    missing = field.default is dataclasses.MISSING
                    cls[name].value = None if missing else repr(field.default)
            if rules(owner) and cls.docstring:
                text = cls.docstring.value
                section = _SECTION.search(text)
                end = section.start() if section else len(text)
                cls.docstring.value = f"{text[:end].rstrip()}\n\n{table(owner)}\n\n{text[end:]}"


def _dataclasses(holder: griffe.Module | griffe.Class) -> Iterator[griffe.Class]:
    for member in holder.members.values():
        if isinstance(member, griffe.Class) and "dataclasses.dataclass" in [d.callable_path for d in member.decorators]:
            yield member
        if isinstance(member, (griffe.Module, griffe.Class)):
            yield from _dataclasses(member)


def table(owner: type) -> str:
    """Return the parameters of a class as a table of Markdown."""
    rows = parameter_rows(owner)
    legend = ["", _escaped(ASSUMED)] if any(row[1].endswith("*") for row in rows) else []
    return "\n".join([markdown([HEAD, *rows]), *legend])


def markdown(rows: Sequence[Sequence[str]]) -> str:
    """Return rows of words as a table of Markdown, of which the first one is the head."""
    head, *body = [f"| {' | '.join(map(_escaped, row))} |" for row in rows]
    return "\n".join([head, "|" + "---|" * len(rows[0]), *body])


def _escaped(words: str) -> str:
    return re.sub(r"([\\`*_{}\[\]|$])", r"\\\1", words).replace("<", "&lt;")
