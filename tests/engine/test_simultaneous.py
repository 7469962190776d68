"""Impacts that follow one another faster than the tolerances tell are one."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from numpy.typing import NDArray

import nonsmooth as ns
from bodies import Ball, Plate
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.memory.modes import Cause

RADIUS, SPEED, TOLERANCE = 0.01, 0.1, 1e-12


def _struck(gap: float, duration: float = 2e-5) -> tuple[int, NDArray[np.float64]]:
    """Return the impacts, and the velocities behind them, of a ball that strikes the first of two, a gap apart."""
    balls = [Ball(RADIUS) for _ in range(3)]
    system = ns.System(balls, gravity=0.0)
    for first, second in itertools.pairwise(balls):
        law = EnergeticImpact(1.0, duration=duration)
        system.contact(first, second, normal=Unilateral(), friction=Frictionless(), impact=law)
    for ball, x in zip(balls, (-1e-3, 2.0 * RADIUS, 4.0 * RADIUS + gap), strict=True):
        system.place(ball, position=(x, 0.0, 0.0), velocity=(SPEED if x < 0.0 else 0.0, 0.0, 0.0))
    solution = ns.simulate(system, 0.02)
    return int(np.sum(solution.events.cause == Cause.IMPACT)), np.array([solution.of(ball)[1][-1, 0] for ball in balls])


def test_a_gap_that_tolerances_explain_closes_within_the_impact() -> None:
    """Half of a thousand tolerances: the balls collide as if they touched."""
    impacts, velocities = _struck(500.0 * TOLERANCE)
    touching = _struck(0.0)
    assert impacts == touching[0] == 1
    assert velocities == pytest.approx(touching[1], abs=1e-9)
    assert abs(velocities[0]) > 1e-3 * SPEED


@pytest.mark.parametrize(("gap", "duration"), [(2000.0 * TOLERANCE, 2e-5), (500.0 * TOLERANCE, 1e-9)])
def test_a_gap_that_takes_longer_closes_behind_it(gap: float, duration: float) -> None:
    """A gap that is wider, or that takes longer than the impact: two impacts, each of which hands all on."""
    impacts, velocities = _struck(gap, duration)
    assert impacts == 2
    assert velocities == pytest.approx([0.0, 0.0, SPEED], abs=1e-9)


def _struck_on_a_floor(gap: float) -> tuple[int, NDArray[np.float64]]:
    """Return the impacts, and the velocities behind them, of a ball that rolls into the first of two that lie."""
    plate, balls = Plate(), [Ball(RADIUS) for _ in range(3)]
    system = ns.System([plate, *balls], gravity=9.81)
    law = EnergeticImpact(1.0)
    for ball in balls:
        system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.3), impact=law)
    for first, second in itertools.pairwise(balls):
        system.contact(first, second, normal=Unilateral(), friction=Frictionless(), impact=law)
    for ball, x in zip(balls, (-1e-3, 2.0 * RADIUS, 4.0 * RADIUS + gap), strict=True):
        speed = SPEED if x < 0.0 else 0.0
        spin = 0.0, speed / RADIUS, 0.0
        system.place(ball, position=(x, 0.0, RADIUS), velocity=(speed, 0.0, 0.0), angular_velocity=spin)
    solution = ns.simulate(system, 0.0101)
    return int(np.sum(solution.events.cause == Cause.IMPACT)), np.array([solution.of(ball)[1][-1, 0] for ball in balls])


def test_a_body_that_goes_on_by_itself_takes_part_as_well() -> None:
    """The last of three balls lies alone on the floor until it is struck over a gap, as if it touched."""
    impacts, velocities = _struck_on_a_floor(500.0 * TOLERANCE)
    touching = _struck_on_a_floor(0.0)
    assert impacts == touching[0] == 1
    assert velocities == pytest.approx(touching[1], abs=1e-7)
    assert velocities[2] > 0.5 * SPEED
