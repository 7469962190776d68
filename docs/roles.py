"""Docstrings name modules and functions with roles (``:func:`f```), unknown to mkdocstrings: make them code."""

from __future__ import annotations

import re
from typing import Any

import griffe

_ROLE = re.compile(r":(?:mod|class|func|meth|data|attr):`~?([^`]+)`")


class Roles(griffe.Extension):
    """Turns roles into code."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Rewrite the docstring of one object."""
        if obj.docstring:
            obj.docstring.value = _ROLE.sub(r"`\1`", obj.docstring.value)
