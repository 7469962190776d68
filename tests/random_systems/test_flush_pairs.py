"""Flush systems in which features, each for itself, do not tell whether bodies touch: they end right."""

from __future__ import annotations

import pytest

from tests.benchmarks.random_systems.generate import flush_case_of
from tests.benchmarks.random_systems.run import run

_SECONDS = 8.0
ENDED = {
    "slide": (700035, 700091, 700131, 700140),
    "fall": (700049, 700075, 700192, 700217),
    "head_on": (700290, 700291),
    "stack": (700081,),
}
"""Systems of discs, cylinders, cones and outlines whose faces, rims or edges meet in line."""


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
@pytest.mark.parametrize("seed", [seed for seeds in ENDED.values() for seed in seeds])
def test_a_flush_system_ends_right(seed: int) -> None:
    outcome = run(flush_case_of(seed), _SECONDS)
    assert (outcome.end, outcome.found) == ("done", ()), outcome.message
