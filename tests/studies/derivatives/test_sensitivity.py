"""Derivatives of motions with respect to parameters, against closed forms and other differences."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import nonsmooth as ns
from bodies import Ball, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.plugins import registry
from nonsmooth.studies.derivatives.differences import CENTRAL
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.derivatives.flow import flow
from nonsmooth.studies.derivatives.forward import NotDifferentiable, sensitivity
from scenarios.dumbbell import DumbbellScenario
from scenarios.rocking_block import RockingBlock

Floats = NDArray[np.float64]
pytestmark = pytest.mark.skipif(PLAIN, reason="hundreds of runs take minutes in plain mode")
G = 9.81


def _ball(
    height: float = 0.1, restitution: float = 0.7, friction: float = 0.2, speed: float = 1.0, across: float = 0.4
) -> ns.System:
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball], gravity=G)
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(friction), impact=EnergeticImpact(restitution))
    system.place(ball, position=(0.0, 0.0, 0.01 + height), velocity=(speed, across, 0.0))
    return system


def test_a_ball_that_bounces() -> None:
    """The first impact is at sqrt(2 h / g), from which it flies at e v; the derivative is due to its time as well."""
    family = Family(_ball, {"height": 0.1, "restitution": 0.7, "friction": 0.0})
    t = 0.2
    found = sensitivity(family, ("height", "restitution"), at=[t])
    struck, speed = math.sqrt(0.2 / G), math.sqrt(0.2 * G)
    by_height = 1.0 / (struck * G), 1.0 / struck / 1.0
    # v = e v0 - g (t - t0), z = e v0 (t - t0) - g (t - t0)^2 / 2
    flown = t - struck
    velocity = 0.7 * by_height[1] + G * by_height[0]
    place = 0.7 * by_height[1] * flown - 0.7 * speed * by_height[0] + G * flown * by_height[0]
    np.testing.assert_allclose(found.u_by[0, 2], [velocity, speed], rtol=1e-8)
    np.testing.assert_allclose(found.q_by[0, 2], [place, speed * flown], rtol=1e-8)
    assert np.all(found.error < 1e-7)


def _idle(idle: float) -> ns.System:
    return _ball(height=0.1)


def test_what_has_no_effect_has_the_derivative_0_without_an_error() -> None:
    found = sensitivity(Family(_idle, {"idle": 0.3}), ("idle",), at=[0.1, 0.2])
    assert not np.any(found.q_by)
    assert not np.any(found.u_by)
    assert found.error.tolist() == [0.0]


@pytest.mark.slow
def test_a_ball_that_slides_in_space() -> None:
    """It slides from the start: friction takes mu g along the slip, and the spin makes it roll in the end."""
    family = Family(_ball, {"height": 0.0, "friction": 0.2, "speed": 1.0}, ns.EventDriven(tolerance=1e-12))
    t, slip = 0.1, np.array([1.0, 0.4])
    way = slip / np.linalg.norm(slip)
    found = sensitivity(family, ("friction", "speed"), at=[t, 1.0])
    np.testing.assert_allclose(found.u_by[0, :2, 0], -G * t * way, rtol=1e-7)
    turn = (np.eye(2)[0] - way * way[0]) / np.linalg.norm(slip)
    np.testing.assert_allclose(found.u_by[0, :2, 1], [1.0, 0.0] - 0.2 * G * t * turn, rtol=1e-7)
    # rolling at 5/7 of the speed: what friction was does not matter any more
    np.testing.assert_allclose(found.u_by[1, :2], [[0.0, 5.0 / 7.0], [0.0, 0.0]], atol=1e-7)


def test_a_block_that_rocks() -> None:
    """It strikes its other corner, which leaves it the square of Housner's ratio of its energy above lying flat."""
    known = {"tilt": 0.15, "base": 0.25}
    height, t = 1.0, 0.9
    found = sensitivity(RockingBlock(friction=0.5, restitution=0.0, height=height, **known), tuple(known), at=[t])

    def excess(tilt: float, base: float, z: float, u: Floats) -> float:
        """Kinetic energy and height above lying flat, less what Housner leaves; of a mass of 1."""
        lift = 0.5 * (base * math.sin(tilt) + height * math.cos(tilt) - height)
        ratio = 1.0 - 1.5 * base**2 / (base**2 + height**2)
        moment = (base**2 + height**2) / 12.0
        kinetic = 0.5 * (u[0] ** 2 + u[1] ** 2 + moment * u[2] ** 2)
        return float(kinetic + G * (z - 0.5 * height) - ratio**2 * G * lift)

    assert abs(excess(0.15, 0.25, found.q[0, 1], found.u[0])) < 1e-10
    for k, name in enumerate(known):
        # it is zero whatever the parameter is: what it changes by itself is what motion and start make up for
        explicit, h = 0.0, 1e-3
        for i, weight in CENTRAL:
            changed = known | {name: known[name] + i * h}
            explicit += weight / h * excess(z=float(found.q[0, 1]), u=found.u[0], **changed)
        moment = (known["base"] ** 2 + height**2) / 12.0
        by_motion = float(found.u[0] * [1.0, 1.0, moment] @ found.u_by[0, :, k]) + G * found.q_by[0, 1, k]
        assert by_motion == pytest.approx(-explicit, rel=1e-7)


CASES: dict[str, tuple[dict[str, Any], tuple[str, ...], float]] = {
    "newtons_cradle": ({"restitution": 0.9}, ("speed", "restitution"), 0.03),
    "woodpecker": ({}, ("beak_restitution", "spring"), 0.1),
    "dumbbell": ({"mode": "drift"}, ("friction", "restitution"), 0.15),
    "rocking_block": (
        {"friction": 0.5, "restitution": 0.0, "base": 0.25, "height": 1.0, "tilt": 0.15},
        ("tilt", "base"),
        0.9,
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
def test_the_error_is_small_and_told(name: str) -> None:
    """Differences of eighth order with steps of their own agree to 1e-7 of the largest derivative."""
    given, parameters, t = CASES[name]
    family = Family.of(registry.load("scenarios", name)(**given))
    found = sensitivity(family, parameters, at=[t])
    for k, parameter in enumerate(parameters):
        value, total = family[parameter], np.zeros(found.u.shape[1])
        for i, weight in ((1, 4.0 / 5.0), (2, -1.0 / 5.0), (3, 4.0 / 105.0), (4, -1.0 / 280.0)):
            for sign in (-1.0, 1.0):
                model = family.model(**{parameter: value * (1.0 + sign * i * 7e-5)})
                total += sign * weight * flow(model, model.start, t).state.u / (7e-5 * value)
        largest = np.max(np.abs(total))
        np.testing.assert_allclose(found.u_by[0, :, k], total, atol=1e-7 * largest, rtol=0.0)
        assert found.error[k] < 1e-7


def test_where_events_change_their_order_there_is_none() -> None:
    """Both balls of a level dumbbell strike at once."""
    with pytest.raises(
        NotDifferentiable, match=r"beta0 must not reorder events; event 2 is impact of 'plate - dumbbell"
    ):
        sensitivity(DumbbellScenario(mode="jump"), ("beta0",), at=[0.1])


def test_bad_input() -> None:
    scenario = DumbbellScenario()
    with pytest.raises(ns.InvalidInput, match="Did you mean 'friction'"):
        sensitivity(scenario, ("frictoin",), at=[0.1])
    for at in ([], [0.0], [0.2, 0.1]):
        with pytest.raises(ns.InvalidInput, match="positive, rising times"):
            sensitivity(scenario, ("friction",), at=at)
    with pytest.raises(ns.InvalidInput, match="must be of a scenario, a system or a family"):
        sensitivity("dumbbell", ("friction",), at=[0.1])  # type: ignore[arg-type]
