"""Bodies that start in one another are refused by name, also where no features face; those that touch are not."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import (
    Ball,
    BoxBody,
    CapsuleBody,
    ConeBody,
    CylinderBody,
    DiscBody,
    EllipsoidBody,
    Plate,
)
from laws import HuntCrossley
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces import Body
from nonsmooth.model.assembly import assemble, lay_out
from tests.solids.kinds import angle

CUBE, ROD, DISC = BoxBody(0.01, 0.01, 0.01), CylinderBody(0.002, 0.04), DiscBody(0.02, 10.0)
ROUND = DiscBody(0.02, 10.0, rounding=0.004)
TILTED = (np.cos(np.pi / 8), np.sin(np.pi / 8), 0.0, 0.0)
QUARTER = (np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0)
INSIDE: dict[str, tuple[Body, Body, Any, Any]] = {
    "bottoms in one plane": (BoxBody(0.02, 0.02, 0.01), CUBE, (0.0, 0.0, 0.0), None),
    "equal boxes": (CUBE, BoxBody(0.01, 0.01, 0.01), (0.0, 0.0, 0.0), None),
    "equal boxes shifted": (CUBE, BoxBody(0.01, 0.01, 0.01), (0.005, 0.0, 0.0), None),
    "crossed plates": (BoxBody(0.05, 0.01, 0.01), BoxBody(0.01, 0.05, 0.01), (0.0, 0.0, 0.0), None),
    "crossed bars": (BoxBody(0.05, 0.01, 0.01), BoxBody(0.01, 0.05, 0.005), (0.0, 0.0, 0.001), None),
    "equal capsules": (CapsuleBody(0.01, 0.02), CapsuleBody(0.01, 0.02), (0.0, 0.0, 0.0), None),
    "equal cylinders": (CylinderBody(0.01, 0.02), CylinderBody(0.01, 0.02), (0.0, 0.0, 0.0), None),
    "crossed cylinders": (CylinderBody(0.01, 0.04), CylinderBody(0.01, 0.04), (0.0, 0.0, 0.0), QUARTER),
    "rod through a box": (BoxBody(0.02, 0.02, 0.01), ROD, (0.001, 0.002, 0.0), None),
    "tilted rod through a box": (BoxBody(0.02, 0.02, 0.01), ROD, (0.001, 0.002, 0.0), (0.98, 0.199, 0.0, 0.0)),
    "rod through a disc": (DISC, ROD, (0.001, 0.002, 0.0), None),
    "disc through a disc": (DISC, DiscBody(0.02, 10.0), (0.001, 0.002, 0.0), QUARTER),
    "disc through a box": (CUBE, DiscBody(0.03, 10.0), (0.001, 0.002, 0.001), (0.9, 0.3, 0.3, 0.1)),
    "disc in a rounded box": (BoxBody(0.03, 0.03, 0.01, rounding=0.004), DISC, (0.0, 0.0, 0.0), None),
    "disc and capsule": (ROUND, CapsuleBody(0.003, 0.003), (0.0, 0.0, 0.0), None),
    "rounded disc and box": (ROUND, BoxBody(5e-3, 5e-3, 5e-3, rounding=1e-3), (0, 0, 0), (0.8, 0.36, -0.48, 0.0)),
    "cone in a cone": (ConeBody(0.04, 0.06), ConeBody(0.004, 0.006), (0.0, 0.0, 0.0), None),
    "equal ellipsoids": (EllipsoidBody(0.01, 0.02, 0.03), EllipsoidBody(0.01, 0.02, 0.03), (0.0, 0.0, 0.0), None),
    "equal meshes": (angle(0.01), angle(0.01), (0.0, 0.0, 0.0), None),
    "ellipsoid in a mesh": (angle(0.04), EllipsoidBody(0.005, 0.006, 0.007), "inside", None),
    "box across a mesh": (angle(0.02), BoxBody(0.05, 0.004, 0.004), "inside", None),
}


def _system(build: Any, one: Body, two: Body, place: Any, turn: Any, **laws: Any) -> ns.System:
    system = ns.System([one, two], gravity=0.0)
    system.contact(one, two, **(laws or build.laws()))
    if isinstance(place, str):
        place = one.frames[0][0].solid.surface.inner[0]  # type: ignore[union-attr]
    orientation = np.array([1.0, 0.0, 0.0, 0.0]) if turn is None else np.array(turn) / np.linalg.norm(turn)
    system.place(two, position=place, orientation=orientation)
    return system


@pytest.mark.fast_cases(11)
@pytest.mark.parametrize("name", INSIDE)
def test_bodies_in_one_another_are_refused(build: Any, name: str) -> None:
    """Before anything runs, with the names of both, the overlap and what to do."""
    one, two, place, turn = INSIDE[name]
    system = _system(build, one, two, place, turn)
    with pytest.raises(ns.InvalidInput) as caught:
        assemble(system, EventDriven())
    for word in ("start of the contact", *system.names.bodies, "overlap", "but it is -0.0", "apart"):
        assert word in str(caught.value)


def test_a_body_that_was_not_placed_is_named(build: Any) -> None:
    floor, ball, other = Plate(), Ball(0.01), Ball(0.01)
    system = ns.System([floor, ball, other])
    system.contact_all(ns.ContactLaws(**build.laws()))
    system.place(other, position=(0.1, 0.0, 0.01))
    with pytest.raises(ns.InvalidInput, match=r"by System\.place\. At the default position: 'ball 1'\.$"):
        ns.simulate(system, 0.1)
    system.place(ball, position=(0.0, 0.0, 0.005))
    with pytest.raises(ns.InvalidInput, match=r"by System\.place\.$"):
        ns.simulate(system, 0.1)


@pytest.mark.parametrize("name", ["crossed bars", "rod through a box", "ellipsoid in a mesh"])
def test_a_body_is_led_out_of_another(build: Any, name: str) -> None:
    """What is refused can be placed by `touching`, and then starts."""
    one, two, place, turn = INSIDE[name]
    system = _system(build, one, two, place, turn)
    q = system.start(two)[0]
    ns.touching(system, two, direction=(0.1, 0.2, -1.0), position=q[:3], orientation=q[3:])
    assert float(np.min(assemble(system, EventDriven()).gaps())) >= -1e-12


def test_compliant_bodies_may_overlap(build: Any) -> None:
    """How deep they are in each other is what their force is made of."""
    law = HuntCrossley(stiffness=1e6, dissipation=0.1)
    for place in ((0.0, 0.0, 0.0199), (0.0, 0.0, 0.0)):
        laws = {"normal": law, "friction": build.laws(friction=0.0)["friction"]}
        assemble(_system(build, Ball(0.01), Ball(0.01), place, None, **laws), EventDriven())


@pytest.mark.fast_cases(5)
@pytest.mark.parametrize("name", INSIDE)
def test_compliant_bodies_that_do_not_feel_their_overlap_are_refused(build: Any, name: str) -> None:
    """A start in which a force comes from no gap would run as if nothing were there."""
    laws = {
        "normal": HuntCrossley(stiffness=1e6, dissipation=0.1),
        "friction": build.laws(friction=0.0)["friction"],
    }
    system = _system(build, *INSIDE[name], **laws)
    if float(np.min(lay_out(system, EventDriven()).gaps())) < 0.0:
        assemble(system, EventDriven())
    else:
        with pytest.raises(ns.InvalidInput, match="must not overlap"):
            assemble(system, EventDriven())


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize(("gap", "starts"), [(0.0, True), (-0.9e-8, True), (-1.1e-7, False)])
def test_bodies_that_touch_start(build: Any, gap: float, starts: bool) -> None:
    """On faces, edges and rims, up to a millionth of their size and the height of feet."""
    cylinder = CylinderBody(0.01, 0.02, foot_height=0.0)
    for one, two, place, turn in (
        (CUBE, BoxBody(0.01, 0.01, 0.01), (0.003, 0.0, 0.02), None),
        (
            CUBE,
            BoxBody(0.01, 0.01, 0.01),
            (0.003, 0.0, 0.01 + 0.01 * np.sqrt(2.0)),
            (np.cos(np.pi / 8), 0.38268343, 0, 0),
        ),
        (CUBE, cylinder, (0.003, 0.0, 0.03), None),
        (cylinder, CylinderBody(0.01, 0.02, foot_height=0.0), (0.02, 0.0, 0.0), None),
        (angle(0.01), BoxBody(0.01, 0.01, 0.01), (0.0, 0.0, 0.015), None),
    ):
        away = np.array(place) * (np.array(place) == np.max(place))
        system = _system(build, one, two, np.array(place) + gap * np.sign(away), turn)
        if starts:
            assemble(system, EventDriven())
        else:
            with pytest.raises(ns.InvalidInput, match="must not overlap"):
                assemble(system, EventDriven())
