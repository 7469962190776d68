"""FeaturePair: the geometry of one potential contact, and CandidateSearch, which finds its features."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import final

from nonsmooth.parameters import Rule, Value


@final
@dataclass(frozen=True, eq=False)
class CandidateSearch:
    """Search for pairs of near features of two shapes, if the pairs are too many for a contact each.

    The search serves all contacts that one call of ``between`` returns.  Each contact gets one pair as the argument
    ``candidate`` of its evaluator.  This vector has four numbers.  Three describe the pair; the first of them is 0
    without a pair.  The fourth is the largest distance [m] that the features may move relative to each other before the
    next search.

    Attributes
    ----------
    function : callable
        A plain function ``find(a, b, out, ...)`` of the frame blocks of the bodies.  On entry, ``out[0]`` is a distance
        [m].  The function writes to ``out[0]`` the number of pairs of features that may be within this distance.  From
        ``out[1]`` on it writes three numbers for each pair.  It writes at most one pair more than there are contacts:
        this pair shows that the contacts are too few.  The first number of a pair is not 0.
    values : mapping
        Parameters of the function by name.
    counts : mapping
        First number of a pair -> (m, n): the second number of the pair is an integer from 0 to m - 1, the third one an
        integer from 0 to n - 1.  Pairs that are read from a file are checked by these limits.
    """

    function: Callable[..., None]
    values: Mapping[str, Value]
    counts: Mapping[float, tuple[int, int]]


@final
@dataclass(frozen=True)
class FeaturePair:
    """The geometry of one potential contact: a feature of each body, and the function that measures them.

    Attributes
    ----------
    evaluator : callable
        A plain function ``evaluate(a, b, out, ...)``; a and b are the frame blocks of the two bodies, out the geometry
        block (:mod:`nonsmooth.engine.memory.blocks`).
    values : mapping
        Parameters of the evaluator by name.
    features : tuple of str
        Names of the pairs of features that can touch; the geometry block holds the number of the present one.
    candidates : CandidateSearch or None
        Search that finds the pair of features; None if the pair never changes.
    bound : callable or None
        Plain function that computes a lower bound of the displacement before the contact can close; None without one.
        ``bound(a, b, out, ...)`` has the arguments of the evaluator.  It writes to ``out[0]`` a distance [m]: the
        contact stays open while the largest displacements of a point of either body add up to less.  Among convex
        bodies a contact is left out until they have moved that far.
    """

    evaluator: Callable[..., None]
    values: Mapping[str, Value] = field(metadata={"rule": Rule("parameters of the evaluator by name", unit="")})
    features: tuple[str, ...]
    candidates: CandidateSearch | None = None
    bound: Callable[..., None] | None = None

    def parameters(self) -> Mapping[str, Value]:
        """Return the parameters of the evaluator by name."""
        return self.values
