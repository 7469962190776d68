"""Impacts that follow one another faster than the tolerances tell are one, and forces that lead nowhere are let be."""

from __future__ import annotations

import itertools
import math
import os
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch

import numpy as np
import pytest
from numpy.typing import NDArray

import nonsmooth as ns
from bodies import Ball, Plate
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.events import averaging
from nonsmooth.engine.memory.modes import IMPACT, OPEN

RADIUS, SPEED, TOLERANCE = 0.01, 0.1, 1e-12
_UNREAD: Any = None
"""A heap that a kernel by itself does not read."""


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
    return int(np.sum(solution.events.cause == IMPACT)), np.array([solution.of(ball)[1][-1, 0] for ball in balls])


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
    return int(np.sum(solution.events.cause == IMPACT)), np.array([solution.of(ball)[1][-1, 0] for ball in balls])


def test_a_body_that_goes_on_by_itself_takes_part_as_well() -> None:
    """The last of three balls lies alone on the floor until it is struck over a gap, as if it touched."""
    impacts, velocities = _struck_on_a_floor(500.0 * TOLERANCE)
    touching = _struck_on_a_floor(0.0)
    assert impacts == touching[0] == 1
    assert velocities == pytest.approx(touching[1], abs=1e-7)
    assert velocities[2] > 0.5 * SPEED


@pytest.mark.skipif("NONSMOOTH_PLAIN" not in os.environ, reason="calls kernels by themselves")
def test_forces_that_lead_nowhere_are_asked_for_ever_more_rarely() -> None:
    """Of a second of averaging by steps of the contact time few begin with a look for other forces."""
    time, nowhere = 1e-3, 1.0
    S: Any = SimpleNamespace(n_active=2, t=-nowhere)
    contact = SimpleNamespace(averaged=OPEN, mean_asked=-math.inf, mean_wait=0.0, mean_span=0.0, mean_force=[0.0] * 3)
    looks = []
    with patch.multiple(
        averaging,
        active_at=lambda *_: SimpleNamespace(slot=0),
        contact_at=lambda *_: contact,
        averaging_time=lambda *_: time,
        is_averaged=lambda *_: int(contact.averaged != OPEN),
        is_settled=lambda *_: 1,
    ):
        assert averaging.average_active(S, _UNREAD, _UNREAD) == 1
        assert contact.mean_wait == 0.0
        while S.t < 0.0:
            if averaging.keeps_averaging(S, _UNREAD, _UNREAD, 1) == 0:
                looks.append(S.t)
                contact.mean_asked, contact.averaged = S.t, OPEN
                assert averaging.average_active(S, _UNREAD, _UNREAD) == 1
            S.t += time
        assert 3 < len(looks) <= 2 + np.log2(nowhere / time)
        # forces of the instant that went on for longer than they had been waited for are asked for at once
        contact.mean_asked, contact.averaged = S.t, OPEN
        S.t += 2.0 * contact.mean_wait
        assert averaging.average_active(S, _UNREAD, _UNREAD) == 1
        assert averaging.keeps_averaging(S, _UNREAD, _UNREAD, 1) == 0
