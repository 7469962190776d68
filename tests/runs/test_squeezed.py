"""A body that driven ones squeeze: rigid bodies have no answer, and the run says so by name."""

from __future__ import annotations

import math
from typing import Any

import pytest

import nonsmooth as ns
from bodies import Ball, BallJoint, ConstantVelocity, Distance, DrivenBody, Plate, Rest, Slider, Sphere
from laws import Coulomb, EnergeticImpact, LinearCompliant, NewtonImpact, PlasticImpact, Unilateral
from nonsmooth.interfaces import ImpactLaw, Joint, NormalLaw
from tests.benchmarks.random_systems.run import NO_ANSWER

RADIUS = 0.01
IMPACTS: list[ImpactLaw] = [EnergeticImpact(0.5), NewtonImpact(0.5), PlasticImpact()]


def _system(normal: NormalLaw, impact: ImpactLaw | None, friction: float, aside: float) -> ns.System:
    """Return a ball on a plate under a sphere that comes down at 0.1 m/s, ``aside`` of it."""
    plate, ball = Plate(Rest()), Ball(RADIUS)
    press = DrivenBody(ConstantVelocity((0.0, 0.0, -0.1), position=(aside, 0.0, 0.05)), (Sphere(0.02),))
    system = ns.System([plate, press, ball])
    laws: dict[str, Any] = {"normal": normal, "friction": Coulomb(friction), "impact": impact}
    system.contact(plate, ball, **laws)
    system.contact(press, ball, **laws)
    system.place(ball, position=(0.0, 0.0, RADIUS))
    return system


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("impact", IMPACTS, ids=lambda law: type(law).__name__)
@pytest.mark.parametrize(("friction", "aside"), [(0.5, 0.0), (0.5, 0.006)])
def test_a_ball_between_a_plate_and_what_comes_down_on_it_is_squeezed(
    impact: ImpactLaw, friction: float, aside: float
) -> None:
    """The message names the ball, both contacts, how fast, and what helps."""
    with pytest.raises(ns.RunFailed, match=r"'ball' is squeezed.*plate - ball.*driven body - ball.*compliant"):
        ns.simulate(_system(Unilateral(), impact, friction, aside), 0.3)


def test_springs_have_an_answer() -> None:
    """They give way, as the message says."""
    assert ns.simulate(_system(LinearCompliant(1e5, 1.0), None, 0.5, 0.0), 0.21).status == "done"


def test_what_slips_out_is_not_squeezed() -> None:
    """The line between the points leans by more than either friction holds: the ball is pushed aside, and goes on."""
    assert ns.simulate(_system(Unilateral(), PlasticImpact(), 0.1, 0.02), 0.35).status == "done"


@pytest.mark.fast_cases(5)
@pytest.mark.parametrize("impact", IMPACTS, ids=lambda law: type(law).__name__)
@pytest.mark.parametrize(
    "joint", [BallJoint((0.0, 0.0, 0.0), (0.0, 0.0, 0.03)), Distance(length=0.05)], ids=["ball", "rod"]
)
def test_a_pendulum_that_a_plate_lifts_towards_its_joint_is_squeezed(impact: ImpactLaw, joint: Joint) -> None:
    """Friction holds the line from the contact to the joint, which bears whatever comes: one contact is enough."""
    held = DrivenBody(Rest(position=(0.004, 0.0, 0.06 if isinstance(joint, Distance) else 0.04)), (Sphere(0.002),))
    plate, ball = Plate(ConstantVelocity((0.0, 0.0, 0.1), position=(0.0, 0.0, -0.01))), Ball(RADIUS)
    system = ns.System([plate, held, ball])
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.5), impact=impact)
    system.joint(joint, held, ball)
    system.place(ball, position=(0.004, 0.0, RADIUS))
    with pytest.raises(ns.RunFailed, match=r"'ball' is squeezed.*plate - ball.*joint.*compliant"):
        ns.simulate(system, 0.3)


def _on_a_rail(impact: ImpactLaw, friction: float) -> ns.System:
    """Return a ball on a plate that rises at 0.1 m/s; a rail at an angle of 0.3 rad to the plate holds the ball."""
    rail = Slider((-0.1, 0.0, 0.0), (0.0, 0.0, 0.0), axis=(math.cos(0.3), 0.0, math.sin(0.3)))
    held = DrivenBody(Rest(position=(0.1, 0.0, RADIUS)), (Sphere(0.002),))
    plate, ball = Plate(ConstantVelocity((0.0, 0.0, 0.1), position=(0.0, 0.0, -0.01))), Ball(RADIUS)
    system = ns.System([plate, held, ball])
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(friction), impact=impact)
    system.joint(rail, held, ball)
    system.place(ball, position=(0.0, 0.0, RADIUS))
    return system


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("impact", IMPACTS, ids=lambda law: type(law).__name__)
def test_a_body_on_a_rail_that_friction_holds_is_squeezed(impact: ImpactLaw) -> None:
    """The rail bears any force across it. One of them is in the cone of friction, as the angle is below atan(0.5).

    Campaigns of random systems count such a run as refused, by what it says.
    """
    with pytest.raises(ns.RunFailed, match=r"'ball' is squeezed.*plate - ball.*slider.*compliant") as failure:
        ns.simulate(_on_a_rail(impact, 0.5), 0.3)
    assert any(words in str(failure.value) for words in NO_ANSWER)


def test_a_body_slides_up_a_rail_that_friction_does_not_hold() -> None:
    """The angle of the rail exceeds atan(0.2): the plate lifts the ball, which slides along it."""
    assert ns.simulate(_on_a_rail(PlasticImpact(), 0.2), 0.3).status == "done"


def test_joints_may_be_declared_in_another_order_than_their_bodies() -> None:
    """The memory has the joints articulation by articulation: the joint of a later body, declared first, comes last."""
    held, hook = (DrivenBody(Rest(position=place), (Sphere(0.002),)) for place in ((0.004, 0.0, 0.04), (1.0, 0.0, 1.0)))
    plate, ball = Plate(ConstantVelocity((0.0, 0.0, 0.1), position=(0.0, 0.0, -0.01))), Ball(RADIUS)
    other = Ball(RADIUS)
    system = ns.System([plate, held, hook, ball, other])
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.5), impact=PlasticImpact())
    system.joint(BallJoint((0.0, 0.0, 0.0), (0.0, 0.0, 0.03)), hook, other)
    system.joint(BallJoint((0.0, 0.0, 0.0), (0.0, 0.0, 0.03)), held, ball)
    system.place(ball, position=(0.004, 0.0, RADIUS))
    system.place(other, position=(1.0, 0.0, 0.97))
    with pytest.raises(ns.RunFailed, match=r"'ball 1' is squeezed.*driven body 1 - ball 1.*compliant"):
        ns.simulate(system, 0.3)
