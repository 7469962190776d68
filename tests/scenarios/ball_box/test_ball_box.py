"""Many balls: energy, penetration, weight on the floor, the list of near pairs against all pairs, wrong input."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.engine.kernel import call_room
from nonsmooth.model import units
from nonsmooth.model.assembly import assemble
from scenarios.ball_box.scenario import BallBox


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
    one, two = np.triu_indices(int(scenario.n_balls), 1)
    assert np.min(np.linalg.norm(places[:, one] - places[:, two], axis=2)) >= 2.0 * r - 1e-9
    energy = scenario.kinetic_energy(solution)
    assert energy[-1] < 0.02 * scenario.fall_energy
    end = scenario.summarise(solution)
    assert end["kinetic_share"] * scenario.fall_energy == pytest.approx(solution.energy.kinetic_end, rel=1e-12)
    assert end["closed_contacts"] == scenario.closed_contacts(solution)[-1] >= scenario.n_balls


@pytest.mark.parametrize("friction", [0.3, 0.0])
def test_the_floor_carries_the_weight(runs: dict[float, tuple[BallBox, ns.Solution]], friction: float) -> None:
    """Once all balls lie on the floor, its forces are the weight of all of them, and each ball's its own."""
    scenario, solution = runs[friction]
    again = scenario.build()
    for ball, other in zip(again.bodies[5:], solution.system.bodies[5:], strict=True):
        i_q, i_u = solution.offsets(other)
        again.set_start(ball, solution.q_end[i_q : i_q + 7], solution.u_end[i_u : i_u + 6])
    model = assemble(again, ns.Options())
    model.memory.scalars["t_end"] = model.memory.scalars["sample_interval"] = 1e-6
    call_room("advance", model.memory, 10)
    n = int(model.memory.scalars["n_contacts"][0])
    declared = model.memory.array("identity", n)
    force = model.memory.array("force", 3 * n).reshape(n, 3)[:, 0]
    floor = np.array([again.contacts[c].first is again.bodies[0] for c in declared])
    weight = scenario.mass * 9.81
    assert np.count_nonzero(floor) == scenario.n_balls
    np.testing.assert_allclose(force[floor], weight, rtol=1e-9)
    assert np.sum(force[floor]) == pytest.approx(scenario.n_balls * weight, rel=1e-9)


def test_near_pairs_give_what_all_pairs_give(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ten balls by the list of near pairs and with all contacts in slots, over the first collisions."""
    scenario = BallBox(t_end=0.25)
    ends = []
    for small in (64, 200):
        monkeypatch.setattr(units, "SMALL", small)
        assert (len(units.find_units(scenario.build().contacts).radii) == 0) == (small == 200)
        ends.append(ns.simulate(scenario.build(), scenario.t_end))
    listed, every = ends
    assert listed.counters.impacts == every.counters.impacts > 30
    np.testing.assert_allclose(listed.q_end, every.q_end, rtol=0, atol=1e-9)
    np.testing.assert_allclose(listed.events.time, every.events.time, rtol=0, atol=1e-9)


@pytest.mark.parametrize(("n", "width"), [(1.0, 0.021), (10.0, 0.05), (100.0, 0.1), (300.0, 0.15)])
def test_the_start_is_free_of_overlap(n: float, width: float) -> None:
    """Whatever the number, and the same for the same seed."""
    scenario = BallBox(n_balls=n, box_width=width, seed=7.0)
    places, r = scenario.places(), scenario.radius
    assert np.min(places[:, 2]) > r
    assert np.max(np.abs(places[:, :2])) < 0.5 * width - r
    one, two = np.triu_indices(int(n), 1)
    assert np.min(np.linalg.norm(places[one] - places[two], axis=1), initial=math.inf) > 2.0 * r
    np.testing.assert_array_equal(places, BallBox(n_balls=n, box_width=width, seed=7.0).places())
    assert not np.array_equal(places, BallBox(n_balls=n, box_width=width, seed=8.0).places())


def test_wrong_input() -> None:
    """Parts of balls, parts of seeds, balls that do not fit."""
    with pytest.raises(ns.InvalidInput, match=r"BallBox\.n_balls must be a whole number"):
        BallBox(n_balls=2.5)
    with pytest.raises(ns.InvalidInput, match=r"BallBox\.seed must be a whole number"):
        BallBox(seed=0.5)
    with pytest.raises(ns.InvalidInput, match=r"BallBox\.box_width must be above the diameter"):
        BallBox(box_width=0.02)


def test_figures(tmp_path: Path, runs: dict[float, tuple[BallBox, ns.Solution]]) -> None:
    """Every ball in every view, both histories with a line per run."""
    pytest.importorskip("matplotlib")
    scenario, solution = runs[0.3]
    drawn = scenario.figures(solution)
    assert sorted(drawn) == ["history", "pile"]
    assert [len(axis.patches) for axis in drawn["pile"].axes] == [10] * 4
    assert [len(axis.lines) for axis in drawn["history"].axes] == [1, 1]
    for name, figure in drawn.items():
        figure.savefig(tmp_path / f"{name}.png")
