"""Many balls: energy, penetration, weight on the floor, the list of near pairs against all pairs, wrong input."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.engine.memory import owners
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.model import broad_phase
from nonsmooth.model.assembly import assemble
from nonsmooth.model.row_table import RowTable
from scenarios.ball_box import BallBox


@pytest.fixture(scope="module")
def runs() -> dict[float, tuple[BallBox, ns.Solution]]:
    """With friction, and without."""
    done = {}
    for friction in (0.3, 0.0):
        scenario = BallBox(friction=friction, wall_friction=friction, t_end=2.0)
        done[friction] = scenario, ns.simulate(scenario.build(), 2.0, sample_interval=scenario.sample_interval)
    return done


@pytest.mark.parametrize("friction", [0.3, 0.0])
def test_energy_and_overlap(runs: dict[float, tuple[BallBox, ns.Solution]], friction: float) -> None:
    """The account closes, and no ball enters another, the floor or a wall at any sample."""
    scenario, solution = runs[friction]
    assert solution.energy.residual <= 1e-8
    assert solution.counters.impacts > 100
    places, r = scenario.positions(solution), scenario.radius
    assert np.min(places[:, :, 2]) >= r - 1e-9
    assert np.max(np.abs(places[:, :, :2])) <= 0.5 * scenario.box_width - r + 1e-9
    one, two = np.triu_indices(scenario.n_balls, 1)
    assert np.min(np.linalg.norm(places[:, one] - places[:, two], axis=2)) >= 2.0 * r - 1e-9
    energy = scenario.kinetic_energy(solution)
    assert energy[-1] < 0.02 * scenario.fall_energy
    end = scenario.summarise(solution)
    assert end["kinetic_share"] * scenario.fall_energy == pytest.approx(solution.energy.kinetic_end, rel=1e-12)
    assert end["closed_contacts"] == scenario.closed_contacts(solution)[-1] >= scenario.n_balls


def _forces(scenario: BallBox, solution: ns.Solution) -> tuple[np.ndarray, np.ndarray]:
    """Return the normal forces [N] of the contacts with the floor and with the walls at the end."""
    again = scenario.build()
    for ball, other in zip(again.bodies[5:], solution.system.bodies[5:], strict=True):
        again.set_start(ball, *solution.history("q", "u", times=solution.t_end, of=other).values())
    model = assemble(again, ns.EventDriven())
    model.memory[owners.Request.t_end] = model.memory[owners.Request.sample_interval] = 1e-6
    call_entry("advance", model.memory, 10, 0)
    n = int(model.memory[owners.Island.n_contacts])
    first = [again.contacts[c].first for c in model.memory[owners.ContactRecord.declared][:n]]
    force = model.memory[owners.ContactRecord.force][:n][:, 0]
    on_floor = np.array([body is again.bodies[0] for body in first])
    on_walls = np.array([any(body is wall for wall in again.bodies[1:5]) for body in first])
    return force[on_floor], force[on_walls]


@pytest.mark.parametrize("friction", [0.3, 0.0])
def test_the_floor_carries_the_weight(runs: dict[float, tuple[BallBox, ns.Solution]], friction: float) -> None:
    """Once all balls lie on the floor, it bears the weight of each."""
    scenario, solution = runs[friction]
    floor, _ = _forces(scenario, solution)
    assert len(floor) == scenario.n_balls
    np.testing.assert_allclose(floor, scenario.mass * 9.81, rtol=1e-9)


def test_a_pile_of_two_at_rest() -> None:
    """Wedged between the walls without friction: the floor bears both, and each pair of walls bears as much.

    The centres are one gap g = width - 2 r apart along either side, so that walls press with m g times g over the rise.
    """
    scenario = BallBox(n_balls=2, box_width=0.03, friction=0.0, wall_friction=0.0, t_end=1.0)
    solution = ns.simulate(scenario.build(), scenario.t_end)
    weight, gap, r = scenario.mass * 9.81, scenario.box_width - 2.0 * scenario.radius, scenario.radius
    rise = math.sqrt(4.0 * r**2 - 2.0 * gap**2)
    summary = scenario.summarise(solution)
    assert summary["kinetic_share"] < 1e-12
    assert summary["closed_contacts"] == 6
    assert summary["height"] == pytest.approx(2.0 * r + rise, abs=1e-9)
    floor, walls = _forces(scenario, solution)
    assert np.sum(floor) == pytest.approx(2.0 * weight, rel=1e-9)
    np.testing.assert_allclose(walls[walls > 0.0], [weight * gap / rise] * 4, rtol=1e-6)


def test_near_pairs_give_what_all_pairs_give(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ten balls by the list of near pairs and with all contacts active, over the first collisions."""
    scenario = BallBox(t_end=0.25)
    ends = []
    for small in (64, 200):
        monkeypatch.setattr(broad_phase, "SMALL", small)
        system = scenario.build()
        table = RowTable.of(system.bodies, system.contacts)
        assert (len(broad_phase.find_broad_phase(system.contacts, table, system.bodies).radii) == 0) == (small == 200)
        ends.append(ns.simulate(system, scenario.t_end))
    listed, every = ends
    assert listed.counters.impacts == every.counters.impacts > 30
    np.testing.assert_allclose(listed.q_end, every.q_end, rtol=0, atol=1e-9)
    np.testing.assert_allclose(listed.events.time, every.events.time, rtol=0, atol=1e-9)


@pytest.mark.parametrize(("n", "width"), [(1, 0.021), (10, 0.05), (100, 0.1), (300, 0.15)])
def test_the_start_is_free_of_overlap(n: int, width: float) -> None:
    """Whatever the number, and the same for the same seed."""
    scenario = BallBox(n_balls=n, box_width=width, seed=7)
    places, r = scenario.places(), scenario.radius
    assert np.min(places[:, 2]) > r
    assert np.max(np.abs(places[:, :2])) < 0.5 * width - r
    one, two = np.triu_indices(n, 1)
    assert np.min(np.linalg.norm(places[one] - places[two], axis=1), initial=math.inf) > 2.0 * r
    np.testing.assert_array_equal(places, BallBox(n_balls=n, box_width=width, seed=7).places())
    assert not np.array_equal(places, BallBox(n_balls=n, box_width=width, seed=8).places())


def test_wrong_input() -> None:
    """Parts of balls, parts of seeds, balls that do not fit."""
    parts: dict[str, Any] = {"n_balls": 2.5, "seed": 0.5}
    for name, value in parts.items():
        with pytest.raises(ns.InvalidInput, match=rf"BallBox\.{name} must be an integer"):
            BallBox(**{name: value})
    with pytest.raises(ns.InvalidInput, match=r"BallBox\.box_width must be above the diameter"):
        BallBox(box_width=0.02)


@pytest.mark.slow
def test_figures(runs: dict[float, tuple[BallBox, ns.Solution]]) -> None:
    """Every ball in every view, both histories with a line per run."""
    drawn = BallBox.figures(*runs[0.3])
    assert [len(axes.patches) for axes in drawn["pile"].axes] == [10] * 4
    assert [len(axes.lines) for axes in drawn["history"].axes] == [1, 1]


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize(("n_balls", "friction"), [(2, 0.3), (3, 0.3), (3, 0.0)])
def test_wedged_balls_rest(n_balls: int, friction: float) -> None:
    """In a box of three radii the balls lie on each other and on walls: they rest, on forces that are not unique."""
    scenario = BallBox(n_balls=n_balls, box_width=0.03, friction=friction, wall_friction=friction, t_end=1.0)
    solution = ns.simulate(scenario.build(), 1.0)
    assert solution.status == "done"
    assert solution.energy.residual <= 1e-8
    assert np.max(scenario.positions(solution)[-1, :, 2]) > 2.0 * scenario.radius
    if friction > 0.0:
        # a ball without friction may spin for ever, and one that rolls freely may roll
        assert np.max(np.abs(solution.u_end)) < 1e-7
    on_floor, on_walls = _forces(scenario, solution)
    assert on_floor.min() >= 0.0
    assert on_walls.max() > 0.0
    if friction == 0.0:
        assert on_floor.sum() == pytest.approx(n_balls * scenario.mass * 9.81, rel=1e-9)
