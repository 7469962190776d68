"""Sampling: how the parameters of the runs of a study are chosen."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any

from nonsmooth.studies.sampling.points import Points


class Sampling(ABC):
    """Chooses the parameters of all runs.

    The contract:

    1. ``points`` returns the same each time, and raises InvalidInput where there is nothing to choose from.
    2. ``described`` says how, in words and numbers that JSON has.
    """

    @abstractmethod
    def points(self) -> Points:
        """Return the parameters of all runs.

        Raises
        ------
        InvalidInput
            If an axis is empty, or a value is not finite.
        """

    @abstractmethod
    def described(self) -> Mapping[str, Any]:
        """Return what it is, for the record."""
