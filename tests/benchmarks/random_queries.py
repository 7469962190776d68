"""Does the process survive?  ``python -m tests.benchmarks.random_queries COUNT`` asks so many distances at random.

Of all pairs of kinds, by all ways, apart, near, in one another and at one place, on a grid and anywhere, now and then
with a pose that is none.  Every answer has to lie between its bounds, every error has to be one of ours.
"""

from __future__ import annotations

import itertools
import sys
import time
from dataclasses import dataclass, field

import numpy as np
from numpy.random import Generator

import nonsmooth as ns
from nonsmooth.errors import MissingPackagesError
from tests.queries.shapes import SHAPES, Pose, pose

WAYS = None, None, None, "pair", "fcl", "coal"
_NONE = (np.full(3, np.nan), np.array([1.0, 0.0, 0.0, 0.0])), (np.zeros(3), np.array([1.0, 1.0, 0.0, 0.0]))


@dataclass
class Tally:
    """What came of the questions: numbers of them, of answers by how they were found, and of refusals by error.

    What is wrong counts answers out of their bounds or without numbers.
    """

    asked: int = 0
    wrong: int = 0
    answers: dict[str, int] = field(default_factory=dict)
    refused: dict[str, int] = field(default_factory=dict)


def _pose(rng: Generator) -> Pose:
    kind = int(rng.integers(12))
    if kind == 0:
        return _NONE[int(rng.integers(2))]
    if kind < 3:
        quarter = np.eye(4)[int(rng.integers(4))]
        return 0.002 * rng.integers(-6, 7, 3), quarter
    return pose(rng, float(rng.choice([0.0, 0.004, 0.01, 0.02, 0.1])))


def ask(count: int, seed: int = 0) -> Tally:
    """Return what comes of so many questions."""
    rng, tally = np.random.default_rng(seed), Tally()
    pairs = list(itertools.product(SHAPES, repeat=2))
    for number in range(count):
        one, two = pairs[int(rng.integers(len(pairs)))] if number >= len(pairs) else pairs[number]
        by = WAYS[int(rng.integers(len(WAYS)))]
        tally.asked += 1
        try:
            found = ns.distance(SHAPES[one], SHAPES[two], at=(_pose(rng), _pose(rng)), by=by)
        except (ns.InvalidInput, ns.NoDistance, MissingPackagesError) as error:
            name = type(error).__name__
            tally.refused[name] = tally.refused.get(name, 0) + 1
            continue
        tally.answers[found.how] = tally.answers.get(found.how, 0) + 1
        numbers = np.concatenate([[found.gap, found.lower, found.upper], found.first, found.second, found.normal])
        right = bool(np.all(np.isfinite(numbers))) and found.lower <= found.gap <= found.upper
        tally.wrong += not right
        if not right:
            print("wrong:", one, two, by, found, flush=True)
    return tally


if __name__ == "__main__":
    began = time.perf_counter()
    print(ask(int(sys.argv[1])), f"{time.perf_counter() - began:.0f} s")
