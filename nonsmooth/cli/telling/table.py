"""Aligned columns of text."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Sequence

_WIDTH = 80
_MARKUP = re.compile(r":\w+:`(?:[^`]*\.)?([^`.]+)`")
"""A reference to a name, of which the last part is kept."""


def lines(rows: Sequence[Sequence[str]], indent: str = "  ") -> list[str]:
    """Return rows of words as lines with aligned columns."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    padded = (indent + "  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True)) for row in rows)
    return [line.rstrip() for line in padded]


def folded(rows: Sequence[Sequence[str]], indent: str = "  ") -> list[str]:
    """Return the same, the last column folded so that no line is wider than a terminal of old."""
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


def first_line(owner: type) -> str:
    """Return the first line of a class's docstring, without markup."""
    line = (owner.__doc__ or "").strip().partition("\n")[0]
    return _MARKUP.sub(r"\1", line).replace("``", "")
