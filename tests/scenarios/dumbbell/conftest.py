"""Runs of the dumbbell that several tests share."""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import pytest

import nonsmooth as ns
from scenarios.dumbbell import DumbbellScenario


@dataclass(frozen=True)
class Run:
    """A scenario, its solution and its summary."""

    scenario: DumbbellScenario
    solution: ns.Solution
    summary: Mapping[str, Any]


@functools.cache
def _run(parameters: tuple[tuple[str, Any], ...]) -> Run:
    scenario = DumbbellScenario(**dict(parameters))
    solution = ns.simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval)
    return Run(scenario, solution, scenario.summarise(solution))


@pytest.fixture(scope="session")
def dumbbell() -> Callable[..., Run]:
    """Run the scenario with the parameters given, each set once in a session."""
    return lambda **parameters: _run(tuple(sorted(parameters.items())))
