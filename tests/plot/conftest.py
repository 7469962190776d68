"""No figure asks for a display, and runs are made once."""

from __future__ import annotations

from typing import Any

import matplotlib
import pytest

import nonsmooth as ns
from bodies import Ball


@pytest.fixture(autouse=True)
def _without_display() -> None:
    matplotlib.use("Agg")


@pytest.fixture(scope="session")
def bounces(build: Any) -> ns.Solution:
    """Return the run of a ball that falls 0.1 m and bounces with e = 0.8."""
    ball = Ball(0.01)
    system = build.over(ball, restitution=0.8, friction=0.0)
    system.place(ball, position=(0.0, 0.0, 0.11))
    return ns.simulate(system, 0.9, sample_interval=0.01)


@pytest.fixture(scope="session")
def drift() -> ns.Solution:
    """Return a dumbbell on its vibrating plate: open, slip and stick, work and all losses."""
    from nonsmooth.plugins import registry

    return ns.simulate(registry.load("scenarios", "dumbbell")().build(), 0.3)
