"""Parameters that are drawn from ranges: at random, by Sobol's sequence, as a Latin hypercube."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, TypeAlias, final

import numpy as np

from nonsmooth.checks import check_pair, is_finite
from nonsmooth.errors import InvalidInput
from nonsmooth.studies.sampling.sampling import SamplePoints, Sampling
from nonsmooth.types import Array

Range: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class Drawn(Sampling, ABC):
    """Draws from ranges.

    Attributes
    ----------
    n : int
        Number of runs.
    seed : int
        Where the draws come from: the same ones for the same seed.
    ranges : mapping
        Of each parameter its lower end, which belongs to it, and its upper one.
    """

    kind: ClassVar[str]

    n: int
    seed: int
    ranges: Mapping[str, Range]

    def __post_init__(self) -> None:
        for name, least in (("n", 1), ("seed", 0)):
            value = getattr(self, name)
            if not isinstance(value, int) or isinstance(value, bool) or value < least:
                rule = f"must be a whole number from {least} on"
                raise InvalidInput(f"{self.kind}: {name}", rule, value, f"For example {self.kind}(1024, 1, ...).")
        if not self.ranges:
            remedy = f"For example {self.kind}(1024, 1, restitution=(0.5, 0.9))."
            raise InvalidInput(self.kind, "must vary a parameter at least", dict(self.ranges), remedy)
        for name, ends in self.ranges.items():
            check_pair(f"study: {name}", ends)
            if not (is_finite(ends[0]) and is_finite(ends[1]) and ends[0] < ends[1]):
                rule = "must be a range of two finite numbers, the lower one first"
                raise InvalidInput(f"study: {name}", rule, ends, "For example (0.5, 0.9).")

    @abstractmethod
    def unit(self, d: int) -> Array:
        """Return the points in the unit cube of so many dimensions, shape [n, d]."""

    def points(self) -> SamplePoints:
        """Return the draws, scaled to the ranges."""
        unit = self.unit(len(self.ranges))
        ends = zip(unit.T, self.ranges.items(), strict=True)
        return SamplePoints({name: low + (high - low) * part for part, (name, (low, high)) in ends}, {})

    def described(self) -> Mapping[str, Any]:
        """Return number, seed and ranges."""
        ranges = {name: [float(end) for end in ends] for name, ends in self.ranges.items()}
        return {"kind": self.kind, "n": self.n, "seed": self.seed, "ranges": ranges}


@final
@dataclass(frozen=True)
class Random(Drawn):
    """Independent draws; each run has a stream of its own, so that a longer study begins with a shorter one."""

    kind: ClassVar[str] = "random"

    def unit(self, d: int) -> Array:
        """Draw run by run."""
        seeds = (np.random.SeedSequence(self.seed, spawn_key=(run,)) for run in range(self.n))
        return np.array([np.random.default_rng(one).random(d) for one in seeds])


@final
@dataclass(frozen=True)
class Sobol(Drawn):
    """Scrambled points of Sobol's sequence."""

    kind: ClassVar[str] = "sobol"

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.n & (self.n - 1):
            below = 1 << (self.n.bit_length() - 1)
            remedy = f"Take {below} or {2 * below}: other numbers spoil the balance of the sequence."
            raise InvalidInput("sobol: n", "must be a power of two", self.n, remedy)

    def unit(self, d: int) -> Array:
        """Draw all at once."""
        from scipy.stats import qmc

        return np.asarray(qmc.Sobol(d, rng=np.random.default_rng(self.seed)).random(self.n))


@final
@dataclass(frozen=True)
class LatinHypercube(Drawn):
    """A Latin hypercube: each of n equal parts of every range has one run."""

    kind: ClassVar[str] = "latin_hypercube"

    def unit(self, d: int) -> Array:
        """Draw all at once."""
        from scipy.stats import qmc

        return np.asarray(qmc.LatinHypercube(d, rng=np.random.default_rng(self.seed)).random(self.n))


def random(n: int, seed: int = 0, /, **ranges: Range) -> Random:
    """Return independent, uniform draws from ranges.

    Parameters
    ----------
    n : int
        Number of draws.
    seed : int
        Seed of the draws.
    **ranges : tuple of float
        Lower and upper end of each parameter.

    Raises
    ------
    InvalidInput
        If there is no range, or one is empty or not finite.
    """
    return Random(n, seed, ranges)


def sobol(n: int, seed: int = 0, /, **ranges: Range) -> Sobol:
    """Return ``n`` = 2^m scrambled points of Sobol's sequence in ranges.

    Raises
    ------
    InvalidInput
        If ``n`` is no power of two, there is no range, or one is empty or not finite.
    """
    return Sobol(n, seed, ranges)


def latin_hypercube(n: int, seed: int = 0, /, **ranges: Range) -> LatinHypercube:
    """Return a Latin hypercube of ``n`` runs in ranges.

    Raises
    ------
    InvalidInput
        If there is no range, or one is empty or not finite.
    """
    return LatinHypercube(n, seed, ranges)
