"""What stands is not evaluated again: versions of bodies.  A lone contact at rest is solved in closed form."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import nonsmooth as ns
import nonsmooth.runs.loop as loop
from bodies import Ball, Plate, Rest, Spring
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.native.kernel import PLAIN, call_entry
from nonsmooth.engine.numerics.linear import solve_three
from nonsmooth.model.image import Image
from scenarios.ball_box.scenario import BallBox

LAWS: dict[str, Any] = {"normal": Unilateral(), "friction": Coulomb(0.3), "impact": EnergeticImpact(0.7)}
COMPONENTS = st.lists(st.floats(-1.0, 1.0), min_size=9, max_size=9)


def _two_balls(held: bool) -> ns.System:
    """Return two balls over a plate, the first one perhaps on a spring."""
    plate, one, two = Plate(), Ball(0.01), Ball(0.01)
    system = ns.System([plate, one, two])
    for ball, x in ((one, 0.0), (two, 0.1)):
        system.contact(ball, plate, **LAWS)
        system.place(ball, position=(x, 0.0, 0.02), velocity=(0.1, 0.2, 0.3), angular_velocity=(1.0, 2.0, 3.0))
    if held:
        system.load(Spring(stiffness=2.0, length=0.01), plate, one)
    return system


def _blocks(model: Any) -> Any:
    """Return what bodies and contacts have written, bit by bit."""
    memory, n = model._laid.memory, int(model._laid.memory.record["n_contacts"])
    written = memory.floats[memory.blocks : memory.tables], memory.array("rate", 3 * n), memory.array("axes", 9 * n)
    return np.concatenate(written).view(np.int64)


@pytest.mark.parametrize("held", [False, True])
def test_a_state_that_is_evaluated_again_is_no_new_version(held: bool) -> None:
    """Nor changes a number, though a load adds to what a body writes; any other state is one, and all is written."""
    model = ns.assemble(_two_balls(held))
    memory = model._laid.memory
    call_entry("evaluate_at", memory)
    before, version = _blocks(model), memory.array("body_version", 3).copy()
    call_entry("evaluate_at", memory)
    assert np.array_equal(memory.array("body_version", 3), version)
    assert np.array_equal(_blocks(model), before)
    y, start = memory.array("y", model._laid.n_y), memory.array("y", model._laid.n_y).copy()
    y[model._laid.n_q] += 0.25
    call_entry("evaluate_at", memory)
    assert (memory.array("body_version", 3) - version).tolist() == [0, 1, 0]
    assert not np.array_equal(_blocks(model), before)
    y[:] = start
    call_entry("evaluate_at", memory)
    assert np.array_equal(_blocks(model), before)


@pytest.mark.parametrize("held", [False, True])
def test_touching_contacts_are_those_of_the_state_at_hand(held: bool) -> None:
    """What the look at an instant finds from blocks that stand is what it finds where all is written anew."""
    model, fresh = (ns.assemble(_two_balls(held)) for _ in range(2))
    for changed in (0, 2, 9):
        for one in (model, fresh):
            memory = one._laid.memory
            memory.array("y", one._laid.n_y)[changed] += 1e-3
        memory = fresh._laid.memory
        memory.array("body_version", 3)[:] += 5
        memory.array("seen_a", 2)[:] = -1
        for one in (model, fresh):
            call_entry("touch", one._laid.memory)
        assert np.array_equal(_blocks(model), _blocks(fresh))


@pytest.mark.skipif(not PLAIN, reason="a compiled kernel is not called from Python")
@given(factor=COMPONENTS, right=st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3))
@settings(deadline=None)
def test_three_unknowns_are_those_of_the_dense_solution(factor: list[float], right: list[float]) -> None:
    """Of positive definite matrices; where a pivot is small there is no answer."""
    root = np.array(factor).reshape(3, 3)
    matrix = root @ root.T
    rows = [tuple(row) for row in matrix.tolist()]
    solve: Any = solve_three
    found = np.array(solve(*rows, tuple(right), 1e-5))
    smallest = float(np.linalg.eigvalsh(matrix)[0])
    if smallest > 1e-4 * float(matrix.max()):
        assert matrix @ found == pytest.approx(np.array(right), abs=1e-9)
    if np.linalg.matrix_rank(matrix, tol=1e-9 * max(1e-300, float(matrix.max()))) < 3:
        assert np.isnan(found).all()


def test_a_ball_that_rolls_is_held_as_one_beside_a_neighbour_is() -> None:
    """Down a slope, alone and touching another one that rolls with it: by closed form, and by elimination."""
    slope, balls = 0.2, [Ball(0.01) for _ in range(3)]
    normal = math.sin(slope), 0.0, math.cos(slope)
    plate = Plate(Rest(slope=slope))
    system = ns.System([plate, *balls])
    for ball, y in zip(balls, (0.0, 0.1, 0.12), strict=True):
        system.contact(ball, plate, normal=Unilateral(), friction=Coulomb(0.5), impact=EnergeticImpact(0.0))
        system.place(ball, position=(0.01 * normal[0], y, 0.01 * normal[2]))
    system.contact(balls[1], balls[2], normal=Unilateral(), friction=Coulomb(0.5), impact=EnergeticImpact(0.0))
    solution = ns.simulate(system, 0.2)
    way = 0.5 * 5.0 / 7.0 * 9.81 * math.sin(slope) * 0.2**2
    for i in range(3):
        x, _, z = solution.q_end[7 * i : 7 * i + 3] - 0.01 * np.array(normal)
        assert math.hypot(x, z) == pytest.approx(way, rel=1e-7)


def test_images_of_large_runs_are_small_beside_what_the_steps_do(monkeypatch: pytest.MonkeyPatch) -> None:
    """Next to the end of a run that may take long steps, but does not: one image in many steps, however large it is."""
    taken: list[int] = []

    class Counted:
        @staticmethod
        def of(memory: Any) -> Image:
            image = Image.of(memory)
            taken.append(image.size)
            return image

    scenario = BallBox(n_balls=20.0, box_width=0.2, t_end=0.2)
    model = ns.assemble(scenario.build())
    monkeypatch.setattr(loop, "Image", Counted)
    solution = model.run(scenario.t_end, sample_interval=scenario.t_end)
    passes = sum(solution.counters.limits.values())
    assert sum(taken[1:]) <= passes * loop._IMAGE_PER_STEP
