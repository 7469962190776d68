"""Ratios of interleaved measurements: median and spread."""

from __future__ import annotations

import statistics
from dataclasses import dataclass


@dataclass(frozen=True)
class Ratios:
    """Measurements of both sides, in pairs that were made one after the other.

    Attributes
    ----------
    this, other : tuple of float
        What was measured on either side.
    """

    this: tuple[float, ...]
    other: tuple[float, ...]

    @property
    def values(self) -> list[float]:
        """Ratios of this side to the other, in order of size."""
        return sorted(a / b for a, b in zip(self.this, self.other, strict=True))

    @property
    def median(self) -> float:
        """Median of the ratios."""
        return statistics.median(self.values)

    @property
    def quartiles(self) -> tuple[float, float]:
        """The quartiles of the ratios; the least and the largest if there are fewer than four."""
        if len(self.values) < 4:
            return self.values[0], self.values[-1]
        low, _, high = statistics.quantiles(self.values, n=4, method="inclusive")
        return low, high

    def cells(self, scale: float, form: str) -> str:
        """Return the medians of both sides, multiplied by a scale, and of the ratios with all of their spread."""
        medians = (format(scale * statistics.median(row), form) for row in (self.other, self.this))
        low, high = self.quartiles
        ends = f"{low:.3f} to {high:.3f} | {self.values[0]:.3f} to {self.values[-1]:.3f}"
        return f"{' | '.join(medians)} | {self.median:.3f} | {ends}"


HEAD = ("other | this | this / other | quartiles | least to largest", "---|---|---|---|---")
"""Heads of the columns of ``cells``, and the line below."""
