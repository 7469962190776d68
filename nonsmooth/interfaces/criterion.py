"""Criterion: a number of a run, between bounds that somebody else gives."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import final

from nonsmooth.errors import InvalidInput


@final
@dataclass(frozen=True)
class Criterion:
    """A number by which a finished run is judged.

    Attributes
    ----------
    name : str
        What it is, with its unit in brackets ("first breakaway [s]").
    value : float
        What the run gives; nan where it gives none, which fulfils nothing.
    lower, upper : float
        Between which it must lie; they belong to the range.
    source : str
        What says so: a closed form, a law of physics, a publication.  Never a run of this program.

    Raises
    ------
    InvalidInput
        If name or source are empty, or the bounds are no range.
    """

    name: str
    value: float
    lower: float
    upper: float
    source: str

    def __post_init__(self) -> None:
        for word, text in (("name", self.name), ("source", self.source)):
            if not (isinstance(text, str) and text.strip()):
                raise InvalidInput(
                    f"Criterion.{word}", "must be given", text, "Say what the number is, and who says so."
                )
        if math.isnan(self.lower) or math.isnan(self.upper) or self.lower > self.upper:
            remedy = "Give the lower bound first; an infinite one leaves a side open."
            raise InvalidInput(f"Criterion {self.name!r}", "must have a range", (self.lower, self.upper), remedy)
        if math.isinf(self.lower) and math.isinf(self.upper):
            raise InvalidInput(f"Criterion {self.name!r}", "must have a bound", (self.lower, self.upper), "Give one.")

    @classmethod
    def near(cls, name: str, value: float | None, expected: float, tolerance: float, source: str) -> Criterion:
        """Return the criterion that a value is within a tolerance of what is expected; None is no value."""
        given = math.nan if value is None else float(value)
        return cls(name, given, float(expected - tolerance), float(expected + tolerance), source)

    @property
    def fulfilled(self) -> bool:
        """Whether the value lies between the bounds."""
        return self.lower <= self.value <= self.upper
