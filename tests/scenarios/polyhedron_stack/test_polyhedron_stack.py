"""Tower of prisms: it stands, the uppermost slides as far as friction lets it, or falls."""

from __future__ import annotations

import numpy as np
import pytest

import nonsmooth as ns
from scenarios.polyhedron_stack import PolyhedronStack


@pytest.mark.slow
def test_it_stands() -> None:
    """Nothing happens, and nothing moves."""
    tower = PolyhedronStack(push=0.0, t_end=1.0)
    solution = ns.run_scenario(tower)
    assert solution.events.causes() == ["start"]
    assert np.max(np.abs(solution.q - solution.q[0])) <= 1e-11


@pytest.mark.slow
@pytest.mark.parametrize("push", [0.1, 0.25])
def test_the_uppermost_slides_as_far_as_friction_lets_it(push: float) -> None:
    tower = PolyhedronStack(push=push)
    assert tower.stands
    solution = ns.run_scenario(tower)
    criteria = tower.acceptance(solution)
    assert len(criteria) == 3
    assert all(one.fulfilled for one in criteria)
