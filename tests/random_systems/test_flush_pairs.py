"""Flush systems in which features, each for itself, do not tell whether bodies touch: all have to end right."""

from __future__ import annotations

import pytest

from tests.benchmarks.random_systems.generate import flush_case_of
from tests.benchmarks.random_systems.run import run

_SECONDS = 8.0
PASSED = {
    "slide": (700035, 700091, 700131, 700140, 700168, 700211, 700213),
    "at_rest": (700018, 700150, 700216, 700230, 700231),
    "fall": (700049, 700075, 700192, 700217, 700238, 700239, 700269),
    "head_on": (700016, 700059, 700093, 700141, 700151, 700281, 700290, 700291),
    "heap": (700236,),
    "stack": (700064, 700081, 700121, 700144, 700175, 700179, 700200),
}
"""Systems of discs, cylinders, cones and outlines whose faces, rims or edges meet in line."""


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
@pytest.mark.parametrize("seed", [seed for seeds in PASSED.values() for seed in seeds])
def test_a_flush_system_ends_right(seed: int) -> None:
    outcome = run(flush_case_of(seed), _SECONDS)
    assert (outcome.end, outcome.found) == ("done", ()), outcome.message
