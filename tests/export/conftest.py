"""Runs that are exported, made once."""

from __future__ import annotations

import pytest

import nonsmooth as ns
from nonsmooth.plugins import registry


def _run(name: str, t_end: float) -> ns.Solution:
    scenario = registry.load("scenarios", name)()
    return ns.simulate(scenario.build(), t_end, sample_interval=scenario.sample_interval)


@pytest.fixture(scope="session")
def drift() -> ns.Solution:
    """Return a dumbbell on its vibrating plate: a sheet, a solid and a line."""
    return _run("dumbbell", 0.3)


@pytest.fixture(scope="session")
def arm() -> ns.Solution:
    """Return a two-link arm on a belt: strokes that turn, and a sheet that slides in itself."""
    return _run("two_link_arm", 0.4)


@pytest.fixture(scope="session")
def cradle() -> ns.Solution:
    """Return five balls in a row, without a sheet."""
    return _run("newtons_cradle", 0.04)
