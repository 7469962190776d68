"""The first systems and drops, by number: none may say done and be wrong, and what does not end says why.

Whether a run ends, or in time, is not asked here: the command counts that.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable

import pytest

from tests.benchmarks.random_systems import drops, generate
from tests.benchmarks.random_systems.case import Case
from tests.benchmarks.random_systems.run import run

_SECONDS = 1.5
_FLUSH = {"head_on": (1, 16), "slide": (5, 6), "fall": (1, 2, 11), "at_rest": (2, 11), "stack": (5,)}
"""Systems of boxes, hulls and balls."""
_SLOW_FLUSH = {
    "head_on": range(20),
    "slide": range(20),
    "fall": range(20),
    "at_rest": range(20),
    "stack": range(14),
    "heap": range(3, 7),
}
"""The first ones of each family, and small heaps."""
_TUMBLING = [range(k, k + 10) for k in range(0, 60, 10)]
_DROPS = {"0 to 19": range(20), "20 to 39": range(20, 40)}


def _ends_right(case_of: Callable[[int], Case], seeds: Iterable[int]) -> None:
    outcomes = {seed: run(case_of(seed), _SECONDS) for seed in seeds}
    assert {seed: outcome.found for seed, outcome in outcomes.items() if outcome.silent} == {}
    assert {seed: outcome.message for seed, outcome in outcomes.items() if outcome.end == "exception"} == {}


@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
@pytest.mark.parametrize(("family", "seeds"), [("tumbling", (1, 9)), *_FLUSH.items()])
def test_small_systems_are_not_wrong_without_a_word(family: str, seeds: tuple[int, ...]) -> None:
    _ends_right(functools.partial(generate.case_of, family=family), seeds)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
@pytest.mark.parametrize(("family", "seeds"), _SLOW_FLUSH.items())
def test_flush_systems_are_not_wrong_without_a_word(family: str, seeds: Iterable[int]) -> None:
    _ends_right(functools.partial(generate.case_of, family=family), seeds)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
@pytest.mark.parametrize("seeds", _TUMBLING, ids=str)
def test_tumbling_systems_are_not_wrong_without_a_word(seeds: range) -> None:
    _ends_right(functools.partial(generate.case_of, family="tumbling"), seeds)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
@pytest.mark.parametrize("seeds", _DROPS.values(), ids=_DROPS)
def test_drops_are_not_wrong_without_a_word(seeds: Iterable[int]) -> None:
    _ends_right(drops.case_of, seeds)
