"""A falling column against springs in real time, its energy, and wrong input."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import nonsmooth as ns
from scenarios.bead_column import BeadColumn


def _on_springs(scenario: BeadColumn) -> Any:
    """Return the velocities, relative to the fall, after the impact on elastic springs without gravity, by scipy."""
    n = scenario.n_beads
    stiffness = np.array([scenario.wall_stiffness] + [1.0] * (n - 1))

    def slope(t: float, y: Any) -> Any:
        squeezed = -np.diff(np.concatenate([[0.0], y[:n]]))
        force = stiffness * np.maximum(squeezed, 0.0) ** scenario.exponent
        return np.concatenate([y[n:], force - np.append(force[1:], 0.0)])

    start = np.concatenate([np.zeros(n), -np.ones(n)])
    done = solve_ivp(slope, (0.0, 30.0 * n), start, method="DOP853", rtol=1e-12, atol=1e-13, max_step=0.05)
    return done.y[n:, -1]


@pytest.mark.slow
@pytest.mark.parametrize(("n", "exponent"), [(1, 1.0), (1, 1.5), (3, 1.0), (3, 1.5), (10, 1.5)])
def test_against_springs_in_real_time(n: int, exponent: float) -> None:
    """The first impact is the limit of springs, whatever their scale: the same velocities to 1e-8.

    Ten beads on linear springs are left out: they part and meet again while others are still pressed, and the gaps
    that matter then do not exist for an impact at fixed positions.
    """
    scenario = BeadColumn(n_beads=n, exponent=exponent, t_end=0.102)
    solution = ns.simulate(scenario.build(), scenario.t_end, engine=ns.EventDriven(impact_tolerance=1e-11))
    assert solution.events.time[1] == pytest.approx(2.0 * scenario.height / scenario.fall_speed, abs=1e-12)
    summary = scenario.summarise(solution)
    np.testing.assert_allclose(summary["relative_rebound"], _on_springs(scenario), rtol=0, atol=1e-8)


@pytest.mark.parametrize("restitution", [0.0, 0.5, 0.9, 1.0])
def test_energy_and_order(restitution: float) -> None:
    """The account closes over many impacts, beads stay in order and above the wall."""
    scenario = BeadColumn(restitution=restitution)
    solution = ns.simulate(scenario.build(), scenario.t_end)
    assert solution.energy.residual <= 1e-7
    assert (solution.energy.restitution_loss > 1e-6) == (restitution < 1.0)
    z = scenario.heights(solution)
    assert np.min(z[:, 0]) >= scenario.radius - 1e-9
    assert np.min(np.diff(z, axis=1)) >= 2.0 * scenario.radius - 1e-9


def test_wrong_input() -> None:
    """Parts of beads and negative heights are refused."""
    with pytest.raises(ns.InvalidInput, match=r"BeadColumn\.n_beads must be an integer"):
        BeadColumn(**dict[str, Any](n_beads=2.5))
    with pytest.raises(ns.InvalidInput, match=r"BeadColumn\.height"):
        BeadColumn(height=-1.0)
