"""Aligned columns of text."""

from __future__ import annotations

from collections.abc import Sequence


def lines(rows: Sequence[Sequence[str]], indent: str = "  ") -> list[str]:
    """Return rows of words as lines with aligned columns."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    padded = (indent + "  ".join(cell.ljust(w) for cell, w in zip(row, widths, strict=True)) for row in rows)
    return [line.rstrip() for line in padded]


def first_line(owner: type) -> str:
    """Return the first line of a class's docstring."""
    return (owner.__doc__ or "").strip().partition("\n")[0]
