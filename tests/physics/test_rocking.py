"""A box that stands or falls on one of its lower edges lands with the other one, on the same body or on another."""

from __future__ import annotations

import pytest

from tests.physics.rocking import BODIES, SUPPORTS, rocked, time_of_landing


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("below", SUPPORTS)
def test_the_other_edge_lands_when_the_pendulum_says(body: str, below: str) -> None:
    """From rest; time to the tolerance of the integration, no edge inside of a support, and flat in the end."""
    run = rocked(body, below)
    assert run.status == "done"
    assert run.landed == pytest.approx(time_of_landing(), abs=1e-8)
    assert run.depth < 1e-9
    assert run.height == pytest.approx(0.0, abs=1e-9)
    assert run.speed < 1e-9


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("below", SUPPORTS)
@pytest.mark.parametrize("restitution", [0.0, 0.5])
def test_a_box_that_falls_on_an_edge_comes_to_rest_flat(body: str, below: str, restitution: float) -> None:
    run = rocked(body, below, restitution, drop=0.003)
    assert run.status == "done"
    assert run.depth < 1e-9
    assert run.height == pytest.approx(0.0, abs=1e-9)
