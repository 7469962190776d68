"""Balls in a box that slip slowly against walls and each other, together without forces: these are averaged."""

from __future__ import annotations

from typing import cast

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball
from laws import Coulomb
from nonsmooth.engine.memory.modes import Cause
from tests.benchmarks import mixed_balls, pile
from tests.histories.closed import closed_contacts

VARIANT, SEED, T_END = "70mm-8", 3, 0.6
MU, RADIUS = 0.8, mixed_balls.RADIUS


@pytest.fixture(scope="module")
def jammed() -> ns.Solution:
    """Return a run of balls that wedge each other."""
    return ns.assemble(mixed_balls.build(VARIANT, SEED)).run(T_END, sample_interval=1e-3)


def test_a_wedged_pile_goes_on_and_balances_its_energy(jammed: ns.Solution) -> None:
    """No gap is lost while forces are averaged, and what they take is booked."""
    assert jammed.status == "done"
    assert Cause.AVERAGING in jammed.events.cause
    assert jammed.counters.limits["averaging of forces"] > 10
    assert jammed.energy.residual < 1e-8
    balls = [body for body in jammed.system.bodies if isinstance(body, Ball)]
    centres = np.array([jammed.of(ball)[0][:, :3] for ball in balls])
    for i, one in enumerate(centres):
        for point, normal in mixed_balls.planes(VARIANT):
            assert np.min((one - point) @ normal) > RADIUS - 1e-8
        for other in centres[:i]:
            assert np.min(np.linalg.norm(one - other, axis=1)) > 2.0 * RADIUS - 1e-8


def test_averaged_forces_press_and_stay_within_their_cones(jammed: ns.Solution) -> None:
    """Looked at from the outside, at instants in between, where they are found again."""
    events = jammed.events
    begun = events.time[np.flatnonzero(events.cause == Cause.AVERAGING)]
    forces = closed_contacts(jammed, begun[begun < T_END - 1e-5][:50] + 5e-6)
    assert len(forces.contact) > 50
    scale = float(np.max(forces.normal_force))
    laws = [cast(Coulomb, contact.friction).friction for contact in jammed.system.contacts]
    bound = np.array([laws[i] for i in forces.contact]) * forces.normal_force
    assert np.all(forces.normal_force > -1e-8 * scale)
    assert np.all(np.linalg.norm(forces.friction_force, axis=1) < bound + 1e-8 * scale)


def test_a_run_cut_within_an_averaging_goes_on_to_the_last_bit(jammed: ns.Solution) -> None:
    events = jammed.events
    (first, *_) = events.time[events.cause == Cause.AVERAGING]
    model = ns.assemble(mixed_balls.build(VARIANT, SEED))
    t_end = float(first) + 1e-3
    whole = model.run(t_end)
    cut = model.run(float(first) + 7e-6)
    again = model.run(t_end, start=cut.state)
    np.testing.assert_array_equal(again.q_end, whole.q_end)
    np.testing.assert_array_equal(again.u_end, whole.u_end)


@pytest.mark.parametrize(("friction", "balanced"), [(0.2, False), (0.6, True)])
def test_what_tells_a_pile_at_rest(friction: float, balanced: bool) -> None:
    """A ball over two others a bit apart stays if friction holds it: tan(15 deg) = 0.27 at every contact."""
    height = RADIUS * (1.0 + np.sqrt(3.0))
    centres = np.array([[-RADIUS, 0.0, RADIUS], [RADIUS, 0.0, RADIUS], [0.0, 0.0, height]])
    floor = [(np.zeros(3), np.array([0.0, 0.0, 1.0]))]
    found = pile.touches(centres, RADIUS, floor, lambda i, j: friction)
    left = pile.unbalanced(found, RADIUS, np.ones(3), 9.81)
    assert (left < 1e-9) == balanced


@pytest.mark.slow
def test_a_crowd_of_events_in_which_no_slip_is_slow_is_averaged() -> None:
    """Modes of eight wedged balls changed every 3 ns, too seldom for a stall, at 7 ms of processor time each."""
    model = ns.assemble(mixed_balls.build("52mm-8", 0))
    there, looks = model.run(0.314).state, iter(range(3000))
    run = model.run(0.3142, start=there, until=lambda so_far: next(looks, None) is None)
    assert run.t_end == 0.3142
    assert abs(run.energy.residual) < 1e-8
