"""Inputs of the checks: drawn from a fixed seed, shrunk to the smallest that fails."""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

Case = dict[str, float]
"""Numbers by name."""
_LEAST = 1e-3
"""Part of its range by which a number differs from the simplest one at least: nearer to it all is as it is there."""
MOST_TRIALS = 300
"""Inputs that are tried to make a failing one smaller."""


@final
@dataclass(frozen=True)
class Variable:
    """A number that is drawn.

    Attributes
    ----------
    name : str
        Its name in messages.
    low, high : float
        Between which it is drawn.
    simplest : float
        What it is shrunk to.
    log : bool
        Whether its logarithm is drawn evenly.
    whole : bool
        Whether it counts something.
    """

    name: str
    low: float
    high: float
    simplest: float = 0.0
    log: bool = False
    whole: bool = False

    def draw(self, random: np.random.Generator) -> float:
        """Return a number between the bounds."""
        if self.whole:
            return float(random.integers(int(self.low), int(self.high) + 1))
        if self.log:
            return float(math.exp(random.uniform(math.log(self.low), math.log(self.high))))
        return float(random.uniform(self.low, self.high))

    def simpler(self, value: float) -> Iterator[float]:
        """Yield simpler numbers than one, the simplest first."""
        if value == self.simplest:
            return
        yield self.simplest
        if self.whole:
            return
        for share in (0.5, 0.8, 1.0):
            between = self._between(value, share)
            for digits in (0, 1):
                rounded = float(f"{between:.{digits}e}")
                nearer = abs(rounded - self.simplest) < abs(value - self.simplest)
                shorter = share == 1.0 and rounded != value
                apart = self.log or abs(rounded - self.simplest) >= _LEAST * (self.high - self.low)
                if (nearer or shorter) and apart and self.low <= rounded <= self.high:
                    yield rounded

    def _between(self, value: float, share: float) -> float:
        """Return a number between the simplest and a value, at a share of the way."""
        if self.log:
            return float(self.simplest ** (1.0 - share) * value**share)
        return self.simplest + share * (value - self.simplest)


Space = Sequence[Variable]


def draws(space: Space, count: int, seed: str) -> Iterator[Case]:
    """Yield the simplest input, then drawn ones, the same for the same seed."""
    yield {variable.name: variable.simplest for variable in space}
    random = np.random.default_rng(zlib.crc32(seed.encode()))
    for _ in range(count - 1):
        yield {variable.name: variable.draw(random) for variable in space}


def shrink(case: Case, space: Space, fails: Callable[[Case], bool]) -> Case:
    """Return a failing input no simplification of which in one number fails, unless that takes too many trials."""
    left, changed = MOST_TRIALS, True
    while changed:
        changed = False
        for variable in space:
            for value in variable.simpler(case[variable.name]):
                if left == 0:
                    return case
                left -= 1
                simpler = case | {variable.name: value}
                if fails(simpler):
                    case, changed = simpler, True
                    break
    return case
