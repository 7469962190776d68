"""The first systems and drops, by number: none may say done and be wrong, and what does not end says why.

Whether a run ends, or in time, is not asked here: the command counts that.
"""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.benchmarks.random_systems import drops, generate
from tests.benchmarks.random_systems.case import Case
from tests.benchmarks.random_systems.run import run

_SECONDS = 1.5
_PARTS = [(generate.case_of, range(k, k + 10)) for k in range(0, 60, 10)]
_PARTS += [(drops.case_of, range(k, k + 20)) for k in range(0, 40, 20)]


@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
@pytest.mark.parametrize(
    ("case_of", "seeds"), _PARTS, ids=[f"{f.__module__.rsplit('.', 1)[1]}-{s.start}-{s.stop - 1}" for f, s in _PARTS]
)
def test_nothing_is_wrong_without_a_word(case_of: Callable[[int], Case], seeds: range) -> None:
    outcomes = {seed: run(case_of(seed), _SECONDS) for seed in seeds}
    assert {seed: outcome.found for seed, outcome in outcomes.items() if outcome.silent} == {}
    assert {seed: outcome.message for seed, outcome in outcomes.items() if outcome.end == "exception"} == {}
