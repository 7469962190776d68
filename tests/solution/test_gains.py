"""Energy that sustained contacts bring in: none, but where a law stores it or forces are averaged."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, CylinderBody, Plate
from laws import Bristle, Coulomb, EnergeticImpact, LinearCompliant, Unilateral
from nonsmooth.solution.checks import closing_gain, friction_gain


def _slid(laws: Mapping[str, Any]) -> ns.Solution:
    """Return the run of a ball that is pushed along a floor."""
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    system.contact(plate, ball, **laws)
    system.place(ball, position=(0.0, 0.0, 0.01), velocity=(0.2, 0.05, 0.0))
    return ns.simulate(system, 0.3)


def test_sliding_friction_takes_energy_only() -> None:
    """A ball slides until it rolls."""
    solution = _slid({"normal": Unilateral(), "friction": Coulomb(0.3), "impact": EnergeticImpact(0.5)})
    assert solution.energy.friction_loss > 0.0
    assert friction_gain(solution) <= 1e-12 * solution.energy.scale
    assert closing_gain(solution) <= 1e-12 * solution.energy.scale


def test_averaged_normal_forces_may_push_while_a_gap_opens() -> None:
    """As one cylinder comes to rest on another: it is what the history of the losses tells."""
    plate, low, high = Plate(), CylinderBody(0.006, 0.006, rounding=6e-4), CylinderBody(0.006, 0.006, rounding=6e-4)
    system = ns.System([plate, low, high])
    for one, two in ((plate, low), (plate, high), (low, high)):
        system.contact(one, two, normal=Unilateral(), friction=Coulomb(0.1573), impact=EnergeticImpact(0.0))
    system.place(low, position=(0.0, 0.0, 0.006))
    system.place(high, position=(7.2e-12, 6.9e-12, 0.01800873))
    solution = ns.simulate(system, 0.003)
    assert solution.counters.limits["averaging of forces"] > 0
    times = np.unique(np.concatenate([solution.t, solution.events.time]))
    loss = solution.history("closing_loss", times=times)["closing_loss"]
    given = -np.sum(np.minimum(np.diff(loss), 0.0))
    assert given > 0.0
    assert closing_gain(solution) == pytest.approx(given, rel=1e-6)


def test_bristles_give_back_what_they_stored() -> None:
    """As a ball begins to roll on bent bristles: it is what the history of the losses tells."""
    solution = _slid({"normal": LinearCompliant(1e4, 10.0), "friction": Bristle(0.3, 0.4), "impact": None})
    times = np.unique(np.concatenate([solution.t, solution.events.time]))
    loss = solution.history("friction_loss", times=times)["friction_loss"]
    given = -np.sum(np.minimum(np.diff(loss), 0.0))
    assert given > 0.0
    assert friction_gain(solution) == pytest.approx(given, rel=1e-6)
    assert solution.status == "done"


def test_impacts_are_not_counted() -> None:
    """A spinning ball bounces."""
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5))
    system.place(ball, position=(0.0, 0.0, 0.05), angular_velocity=(0.0, 50.0, 0.0))
    assert friction_gain(ns.simulate(system, 0.3)) == 0.0
