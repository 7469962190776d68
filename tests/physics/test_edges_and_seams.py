"""Edges that meet edges at any angle, and bodies that slide over the seam of two others."""

from __future__ import annotations

import math

import pytest

import nonsmooth as ns
from bodies import BoxBody, DrivenBody, HullBody, Rest
from bodies.free import FreeBody
from bodies.shapes.box import Box
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from tests.benchmarks.head_on.meeting import Meeting
from tests.benchmarks.random_systems.families.aligned import UPRIGHT
from tests.physics.head_on import FINE, wrong

TURNS = (0.0, 1e-15, 1e-13, 1e-12, 1e-11, 3e-11, 1e-10, 1e-9, 1e-8, 9e-8, 1.1e-7, 1e-6, 1e-4, 1e-2)
"""Angles between two edges [rad], below and above those up to which the edges count as parallel."""
ASLANT = (0.48, -0.6, 0.64, 0.0)
"""Quaternion of a rotation of both bodies that gives every coordinate round-off."""
START, FAR = -0.3, 0.6
"""Coordinate x at which a body starts, before the seam at x = 0, and the distance that it slides [m]."""


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("world", [UPRIGHT, ASLANT])
@pytest.mark.parametrize(
    ("name", "axis", "parallel"),
    [("prism of 6", 0, 0.0), ("prism of 8", 1, 0.0), ("tetrahedron", 0, 0.5 * math.pi), ("tetrahedron", 0, 0.0)],
)
def test_edge_on_edge_is_central_at_any_angle(
    name: str, axis: int, parallel: float, world: tuple[float, float, float, float]
) -> None:
    """Parallel edges touch at both ends. Other edges touch where they cross, on the line of centres."""
    meetings = [Meeting(name, axis, turn=parallel + turn, world=world) for turn in TURNS]
    assert wrong(meetings, engine=FINE, accuracy=1e-9) == []


def _prism() -> FreeBody:
    """Return a hexagonal prism that stands on its base."""
    angles = [math.pi * k / 3.0 for k in range(6)]
    return HullBody([(0.05 * math.cos(a), 0.05 * math.sin(a), z) for a in angles for z in (-0.03, 0.03)])


def _slide(body: FreeBody, height: float, speed: float, yaw: float = 0.0, friction: float = 0.0, step: float = 0.0):  # type: ignore[no-untyped-def]
    """Let a body slide from one box to another, whose top is higher by ``step`` [m]; return its states over time."""
    floors = [
        DrivenBody(Rest(position=(x, 0.0, z - 0.1)), (Box(0.5, 1.0, 0.1),)) for x, z in ((-0.5, 0.0), (0.5, step))
    ]
    system = ns.System([*floors, body], 9.81)
    law = Coulomb(friction) if friction > 0.0 else Frictionless()
    for floor in floors:
        system.contact(floor, body, normal=Unilateral(), friction=law, impact=EnergeticImpact(0.2))
    turn = ns.turned_about((0.0, 0.0, 1.0), yaw)
    system.place(body, position=(START, 0.03, height), velocity=(speed, 0.0, 0.0), orientation=turn)
    return ns.simulate(system, FAR / speed).of(body)


@pytest.mark.fast_cases(8)
@pytest.mark.parametrize("yaw", [0.0, 1e-9, 1e-6, 0.4, 0.25 * math.pi])
@pytest.mark.parametrize("speed", [0.1, 0.9, 10.0])
@pytest.mark.parametrize("name", ["box", "prism"])
@pytest.mark.filterwarnings("ignore:.*usual range")
def test_a_flush_seam_stops_nothing(name: str, speed: float, yaw: float) -> None:
    """The body slides over the seam as on one plane, with and without friction."""
    for part in (0.0, 0.5):
        # with friction, the body loses half of its kinetic energy; a coefficient above 0.1 would tip it
        friction = min(0.1, part * 0.5 * speed**2 / (9.81 * FAR))
        body, height = (BoxBody(0.1, 0.05, 0.02), 0.02) if name == "box" else (_prism(), 0.03)
        q, u = _slide(body, height, speed, yaw, friction)
        time = FAR / speed
        assert u[-1][0] == pytest.approx(speed - 9.81 * friction * time, rel=1e-6)
        assert abs(u[-1][1:]).max() < 1e-6 * speed
        assert q[-1][0] == pytest.approx(START + speed * time - 0.5 * 9.81 * friction * time**2, abs=1e-6)


@pytest.mark.parametrize("speed", [0.1, 2.0])
@pytest.mark.parametrize("step", [1e-12, 5e-12, 1e-11, 1e-9, 1e-6])
def test_a_lower_neighbour_is_no_obstacle(step: float, speed: float) -> None:
    """The body slides over a step down, and keeps its speed."""
    q, u = _slide(BoxBody(0.1, 0.05, 0.02), 0.02, speed, step=-step)
    assert u[-1][0] == pytest.approx(speed, rel=1e-3)
    assert q[-1][0] == pytest.approx(START + FAR, abs=1e-3)


@pytest.mark.parametrize("step", [1e-9, 1e-6])
def test_a_higher_neighbour_is_one(step: float) -> None:
    """A rigid body bounces off a step up of 1 nm or 1 um."""
    q, _ = _slide(BoxBody(0.1, 0.05, 0.02), 0.02, 1.0, step=step)
    assert q[-1][0] < -0.1
