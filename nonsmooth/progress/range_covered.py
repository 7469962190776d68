"""How much of the range of a parameter is covered."""

from __future__ import annotations

from typing import final

from nonsmooth.progress.pace import Pace


@final
class RangeCovered:
    """Counts the orbits that are found over a parameter, from a value on both ways.

    Parameters
    ----------
    pace : Pace
        Where they are told.
    name : str
        The parameter.
    value : float
        Where it begins.
    span : tuple of float
        Its range: the time left is that to both ends.
    """

    def __init__(self, pace: Pace, name: str, value: float, span: tuple[float, float]) -> None:
        self._pace, self._name, self._range = pace, name, span[1] - span[0]
        self._least = self._most = value
        self._count = 0
        self._tell(value)

    def add(self, value: float) -> None:
        """Count the orbit at a value."""
        self._count += 1
        self._least, self._most = min(self._least, value), max(self._most, value)
        self._tell(value)

    def _tell(self, value: float) -> None:
        def words(elapsed: float) -> tuple[str, str]:
            return f"orbit {self._count}, {self._name} = {value:.6g}", f"{self._count / elapsed:.3g} per s"

        self._pace.show((self._most - self._least) / self._range, words)
