"""What an engine reports of a run besides what all engines do: numbers with names, and causes for which a run ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

FIRST_CODE = 100
"""Least code of a cause of an engine's own; smaller ones are those of :mod:`nonsmooth.engine.memory.modes`."""


@final
@dataclass(frozen=True)
class Measure:
    """A number by which an engine judges its run, such as the largest overlap.

    Attributes
    ----------
    name : str
        Name of the scalar in ``Engine.own`` that holds the number when the run ends.
    unit : str
        SI unit, "1" for a pure number.
    meaning : str
        What the number is, in a few words.
    """

    name: str
    unit: str
    meaning: str


@final
@dataclass(frozen=True)
class EndCause:
    """A cause of an engine's own for which a run ends.

    Attributes
    ----------
    code : int
        The status that ``Engine.advance`` returns, :data:`FIRST_CODE` or more.
    name : str
        Name of the cause, which ``Solution.cause`` gives.
    reason : str
        What happened, as a sentence without its full stop.
    remedy : str
        What the user can do, as a whole sentence.
    is_failure : bool
        Whether the run failed.
    """

    code: int
    name: str
    reason: str
    remedy: str = ""
    is_failure: bool = True
