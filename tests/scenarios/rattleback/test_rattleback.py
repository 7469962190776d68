"""The rattleback: it turns its spin round, against equations of its own, with the energy kept."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.engine.native.kernel import PLAIN
from scenarios.rattleback.rolling import roll
from scenarios.rattleback.scenario import GRAVITY, Rattleback

EXACT = ns.EventDriven(tolerance=1e-12)


def _run(engine: ns.EventDriven | None = None, **given: Any) -> tuple[Rattleback, ns.Solution]:
    scenario = Rattleback(**given)
    solution = ns.run_scenario(scenario, engine)
    assert solution.energy.residual <= 1e-8
    return scenario, solution


@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
def test_it_spins_back_one_way_only() -> None:
    """Spun one way it is turned round within seconds, the other way it goes on for thrice as long."""
    scenario, solution = _run()
    summary = scenario.summarise(solution)
    assert summary["reversed"] == pytest.approx(5.82, abs=0.01)
    assert summary["spin_most"] == pytest.approx(5.0, rel=1e-3)
    scenario, solution = _run(spin=5.0, t_end=17.0)
    assert scenario.summarise(solution)["reversed"] is None


@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
def test_without_skew_it_does_not_turn_round() -> None:
    scenario, solution = _run(product=0.0)
    assert scenario.summarise(solution)["reversed"] is None
    # the energy of the spin stays in it
    assert np.ptp(scenario.spins(solution.q, solution.u)) < 0.01


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
def test_rolling_keeps_the_energy_over_a_hundred_oscillations() -> None:
    """To 1e-9 of kinetic and potential energy, through the reversal; the spin is that of other equations."""
    scenario, solution = _run(EXACT)
    assert scenario.rolls(solution)
    assert scenario.summarise(solution)["oscillations"] >= 100
    energy = scenario.energies(solution.q, solution.u)
    assert np.ptp(energy) <= 1e-9 * energy[0]
    found = {one.name: one.value for one in scenario.acceptance(solution)}
    assert found["deviation of the spin from the equations of rolling"] < 1e-6


def test_the_equations_of_rolling_keep_their_energy() -> None:
    """What the engine is held against is itself held against something."""
    one = Rattleback()
    n, times = one._normal, np.linspace(0.0, 1.0, 50)
    normals, turning = roll(one.semi, one.offset, one.mass, one.tensor, GRAVITY, n, one.spin * n, times)
    stretched = normals * one.semi**2
    lever = stretched / np.sqrt(np.sum(stretched * normals, axis=1))[:, None] - [0.0, 0.0, one.offset]
    speed = np.cross(turning, lever)
    energy = 0.5 * one.mass * np.sum(speed**2, axis=1) + 0.5 * np.sum(turning @ one.tensor * turning, axis=1)
    energy += one.mass * GRAVITY * np.sum(lever * normals, axis=1)
    assert np.ptp(energy) <= 1e-10 * energy[0]
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, rtol=0, atol=1e-10)


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
def test_slip_costs_spin() -> None:
    """With less friction it slips while it rattles, and what it loses is missing in the spin that comes back."""
    most = []
    for friction in (1.0, 0.3, 0.2):
        scenario, solution = _run(friction=friction, t_end=12.0)
        summary = scenario.summarise(solution)
        most.append(summary["spin_most"])
        assert (summary["energy_lost"] > 1e-3) == (friction < 0.5)
        assert scenario.rolls(solution) == (friction > 0.5)
    assert most[0] > most[1] + 1.0 > most[2] + 1.5


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
def test_the_title_says_when_the_spin_is_reversed() -> None:
    scenario, solution = _run(t_end=6.0)
    assert "5.8 s" in scenario.figures(solution)["history"].get_suptitle()
