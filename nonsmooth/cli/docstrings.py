"""Texts of numpy docstrings: the first line, and the description of each parameter."""

from __future__ import annotations

import inspect
import re
from typing import Any

_MARKUP = re.compile(r":\w+:`(?:[^`]*\.)?([^`.]+)`")
"""A reference of Sphinx, such as :class:`nonsmooth.Solution`. Group 1 is the last part of the name."""
_SECTIONS = ("Parameters", "Attributes")


def plain(text: str) -> str:
    """Return a text without markup: references of Sphinx become plain names, double backquotes vanish."""
    return _MARKUP.sub(r"\1", text).replace("``", "")


def first_line(owner: Any) -> str:
    """Return the first line of a docstring, without markup."""
    return plain((owner.__doc__ or "").strip().partition("\n")[0])


def described_parameters(owner: Any) -> dict[str, str]:
    """Return the description of each parameter of a function or class, as one line without markup."""
    lines = (inspect.getdoc(owner) or "").splitlines()
    found, names = dict[str, str](), list[str]()
    is_inside = False
    for line, below in zip(lines, [*lines[1:], ""], strict=True):
        if below.startswith("---"):
            is_inside, names = line in _SECTIONS, []
        elif not is_inside or line.startswith("---"):
            continue
        elif line and not line.startswith(" "):
            names = [name.strip(" *") for name in line.partition(" : ")[0].split(",")]
        else:
            found |= {name: f"{found.get(name, '')} {line.strip()}".strip() for name in names}
    return {name: plain(text) for name, text in found.items()}
