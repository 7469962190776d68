"""Loads: oscillators against closed forms, momentum, and the account."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Bushing, FunctionLoad, Hinge, Plate, Spring, TorsionSpring
from nonsmooth.types import Floats


def _two(load: Any, gravity: float = 0.0) -> tuple[ns.System, Ball, Ball]:
    balls = Ball(0.05), Ball(0.08)
    system = ns.System(balls, gravity)
    system.load(load, *balls)
    return system, *balls


@pytest.mark.parametrize("damping", [0.0, 3.0])
def test_spring_between_two_balls(damping: float) -> None:
    """The distance of two balls on a spring is a damped oscillation about its natural length."""
    system, one, two = _two(Spring(stiffness=200.0, length=0.5, damping=damping))
    system.place(two, position=(0.0, 0.0, 0.6))
    solution = ns.simulate(system, 2.0, engine=ns.EventDriven(tolerance=1e-11))
    mass = 1.0 / (1.0 / one.total_mass + 1.0 / two.total_mass)
    decay = damping / (2.0 * mass)
    omega = math.sqrt(200.0 / mass - decay**2)
    t = solution.t
    truth = 0.5 + 0.1 * np.exp(-decay * t) * (np.cos(omega * t) + decay / omega * np.sin(omega * t))
    np.testing.assert_allclose(solution.of(two)[0][:, 2] - solution.of(one)[0][:, 2], truth, rtol=0, atol=1e-8)
    momentum = one.total_mass * solution.of(one)[1][:, 2] + two.total_mass * solution.of(two)[1][:, 2]
    np.testing.assert_allclose(momentum, 0.0, atol=1e-10)
    kept = 0.5 * 200.0 * (truth[-1] - 0.5) ** 2
    assert solution.energy.residual <= 1e-8
    if damping == 0.0:
        assert solution.energy.load_work == pytest.approx(0.5 * 200.0 * 0.1**2 - kept, abs=1e-8)
    else:
        assert solution.energy.load_work < 0.5 * 200.0 * 0.1**2 - kept


@pytest.mark.parametrize(
    "load",
    [
        Spring(stiffness=50.0, length=0.2, damping=1.0, first=(0.05, 0.0, 0.0)),
        Bushing(50.0, 1.0, second=(0.0, 0.08, 0.0)),
    ],
    ids=["spring", "bushing"],
)
def test_forces_in_pairs(load: Any) -> None:
    """Off-centre springs and dampers on spinning balls keep momentum and angular momentum."""
    system, one, two = _two(load)
    system.place(one, velocity=(0.3, 0.0, -0.1), angular_velocity=(2.0, 1.0, 0.0))
    system.place(two, position=(0.1, 0.2, 0.5), velocity=(0.0, 0.4, 0.0), angular_velocity=(0.0, -3.0, 1.0))
    solution = ns.simulate(system, 1.0, engine=ns.EventDriven(tolerance=1e-11))
    total, turning = np.zeros((len(solution.t), 3)), np.zeros((len(solution.t), 3))
    for ball in (one, two):
        q, u = solution.of(ball)
        s, v = q[:, 3:4], q[:, 4:7]
        # angular velocity in world axes: q (0, omega) q*
        spin = u[:, 3:] + 2.0 * np.cross(v, np.cross(v, u[:, 3:]) + s * u[:, 3:])
        total += ball.total_mass * u[:, :3]
        turning += ball.total_mass * np.cross(q[:, :3], u[:, :3]) + ball.inertia[0] * spin
    np.testing.assert_allclose(total, np.broadcast_to(total[0], total.shape), rtol=0, atol=1e-8)
    np.testing.assert_allclose(turning, np.broadcast_to(turning[0], turning.shape), rtol=0, atol=1e-8)
    assert solution.energy.residual <= 1e-8


def test_torsion_spring_on_a_hinge() -> None:
    """A ball on a hinge with a torsion spring oscillates with sqrt(k / J) about the given angle."""
    plate, ball = Plate(), Ball(0.1)
    system = ns.System([plate, ball], gravity=0.0)
    system.joint(Hinge(), plate, ball)
    system.load(TorsionSpring(2.0, angle=0.5), plate, ball)
    solution = ns.simulate(system, 1.0, engine=ns.EventDriven(tolerance=1e-11))
    q, _ = solution.of(ball)
    omega = math.sqrt(2.0 / ball.inertia[0])
    np.testing.assert_allclose(2.0 * np.arctan2(q[:, 5], q[:, 3]), 0.5 * (1.0 - np.cos(omega * solution.t)), atol=1e-8)


def _drag(t: float, a: Floats, b: Floats, out: Floats, coefficient: float) -> None:
    for i in range(3):
        out[i] = -coefficient * b[12 + i]
        out[3 + i] = b[i]
        out[6 + i] = 0.0


def test_function_of_the_users() -> None:
    """Linear drag: the speed of a fall tends to m g / c as its closed form says."""
    plate, ball = Plate(), Ball(0.02)
    system = ns.System([plate, ball])
    system.load(FunctionLoad(_drag, {"coefficient": 0.3}), plate, ball)
    solution = ns.simulate(system, 2.0)
    rate = 0.3 / ball.total_mass
    truth = -9.81 / rate * (1.0 - np.exp(-rate * solution.t))
    np.testing.assert_allclose(solution.of(ball)[1][:, 2], truth, rtol=0, atol=1e-8)
    assert solution.energy.residual <= 1e-8


def test_wrong_loads() -> None:
    """A missing constant, a thing that is no function, a wrong vector: named before anything runs."""
    plate, ball = Plate(), Ball(0.02)
    system = ns.System([plate, ball])
    system.load(FunctionLoad(_drag), plate, ball)
    with pytest.raises(ns.UnknownName, match="coefficient"):
        ns.simulate(system, 0.1)
    with pytest.raises(ns.InvalidInput, match=r"FunctionLoad.function must be a function"):
        FunctionLoad(3.0)  # type: ignore[arg-type]
    with pytest.raises(ns.InvalidInput, match=r"Spring.first must be 3 finite numbers"):
        Spring(1.0, 1.0, first=(1.0, 2.0))  # type: ignore[arg-type]
    with pytest.raises(ns.InvalidInput, match="needs a Load"):
        system.load(ball, plate, ball)  # type: ignore[arg-type]
