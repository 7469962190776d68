"""Variable: an array with names for its axes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

from numpy.typing import NDArray


@final
@dataclass(frozen=True)
class Variable:
    """An array with names for its axes.

    Attributes
    ----------
    name : str
        Its name.
    dimensions : tuple of str
        Names of its axes.
    values : array
        Its content.
    attributes : mapping
        Unit and what it is.
    """

    name: str
    dimensions: tuple[str, ...]
    values: NDArray[Any]
    attributes: Mapping[str, Any]
