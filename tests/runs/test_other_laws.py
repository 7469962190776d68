"""A model with other laws runs as one that was assembled with them."""

from __future__ import annotations

from typing import Any

import pytest

import nonsmooth as ns
from bodies import Ball, Plate
from laws import Bristle, Coulomb, EnergeticImpact, HuntCrossley, NewtonImpact, Stribeck
from nonsmooth.interfaces import TangentialLaw
from nonsmooth.plugins import registry
from nonsmooth.system.materials import ContactLaws, Materials
from tests.runs.continued import differences

NORMAL = HuntCrossley(1e5, 0.1)


@pytest.mark.parametrize(
    "laws",
    [
        {"friction": Coulomb(0.35)},
        {"impact": EnergeticImpact(0.3)},
        {"friction": Coulomb(0.1, 0.4), "impact": EnergeticImpact(0.9)},
    ],
)
def test_other_numbers(laws: dict[str, Any]) -> None:
    system = registry.load("scenarios", "dumbbell")().build()
    model, other = ns.assemble(system), ns.with_laws(system, **laws)
    before, found = model.run(0.3), model.with_laws_of(other)
    assert differences(found.run(0.3), ns.simulate(other, 0.3)) == []
    assert differences(model.run(0.3), before) == []
    assert found.system is other
    # a state of the one is a start for the other
    assert found.run(0.4, start=before.state).energy.restitution_loss < before.energy.restitution_loss


def test_many_contacts_in_a_list() -> None:
    system = registry.load("scenarios", "ball_box")().build()
    other = ns.with_laws(system, friction=Coulomb(0.05))
    found = ns.assemble(system).with_laws_of(other)
    assert differences(found.run(0.15), ns.simulate(other, 0.15)) == []


def _two_balls(*frictions: TangentialLaw) -> ns.System:
    """A plate and two equal balls that slide on it, each with a law of friction."""
    plate, *balls = Plate(), Ball(0.01), Ball(0.01)
    system, laws = ns.System([plate, *balls]), [ContactLaws(NORMAL, law) for law in frictions]
    materials = Materials({("plate", "one"): laws[0], ("plate", "other"): laws[1]}, default=laws[0])
    system.contact_all(materials, of={"plate": [plate], "one": balls[:1], "other": balls[1:]})
    for i, ball in enumerate(balls):
        system.place(ball, position=(0.1 * i, 0.0, ball.radius), velocity=(0.2, 0.0, 0.0))
    return system


def test_inner_states_keep_the_error_scale_of_their_own_law() -> None:
    system = _two_balls(Bristle(0.3, 0.4, stiffness=1e3), Bristle(0.3, 0.4, stiffness=1e5))
    other = ns.with_laws(system, friction=Bristle(0.3, 0.4, stiffness=1e4))
    found = ns.assemble(system).with_laws_of(other)
    assert differences(found.run(0.05), ns.simulate(other, 0.05)) == []


@pytest.mark.parametrize("order", [1, -1])
def test_contacts_that_had_laws_of_different_kinds_cannot_share_one(order: int) -> None:
    """Whichever comes first: the block of one of them does not fit."""
    bristle = Bristle(0.3, 0.4)
    system = _two_balls(*(bristle, Coulomb(0.3))[::order])
    for law in (bristle, Coulomb(0.2)):
        with pytest.raises(ns.InvalidInput, match="must be of the kinds of"):
            ns.assemble(system).with_laws_of(ns.with_laws(system, friction=law))


def test_what_differs_in_more_than_laws_is_refused(build: Any) -> None:
    system = build.over(Ball(0.01))
    system.place(system.bodies[1], position=(0.0, 0.0, 0.02))
    model = ns.assemble(system)
    with pytest.raises(ns.InvalidInput, match="same bodies"):
        model.with_laws_of(build.over(Ball(0.01)))
    with pytest.raises(ns.InvalidInput, match="same joints, loads, guards and contacts"):
        model.with_laws_of(ns.System(system.bodies))
    for laws in (
        {"friction": Stribeck(0.3, 0.2, 0.1)},
        {"impact": NewtonImpact(0.5)},
        {"normal": HuntCrossley(1e5, 0.1)},
    ):
        with pytest.raises(ns.InvalidInput, match=r"must be of the kinds of Unilateral, Coulomb, EnergeticImpact"):
            model.with_laws_of(ns.with_laws(system, **laws))
