"""A body that slides over the seam of two flush boxes does not feel it."""

from __future__ import annotations

import itertools
from collections.abc import Callable

import pytest
import trimesh

import nonsmooth as ns
from bodies import Box, BoxBody, CylinderBody, DrivenBody, HullBody, MeshBody, Rest, Triangles
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.interfaces import Body
from tests.physics.limited import limited

HALVES = (0.05, 0.03, 0.02)
"""Halves of the body [m]."""
SPEED, FRICTION, GRAVITY = 0.9, 0.1, 9.81


def _mesh() -> Body:
    made = trimesh.creation.box([2.0 * half for half in HALVES])
    return MeshBody(Triangles(made.vertices, made.faces))


BODIES: dict[str, Callable[[], Body]] = {
    "box": lambda: BoxBody(*HALVES),
    "rounded box": lambda: BoxBody(*HALVES, rounding=0.002),
    "hull": lambda: HullBody(list(itertools.product(*((-half, half) for half in HALVES)))),
    "mesh": _mesh,
    "cylinder": lambda: CylinderBody(0.03, 0.02, foot_height=0.0),
}


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("name", BODIES)
@pytest.mark.parametrize("start", [-0.3, -0.29, -0.25])
@pytest.mark.parametrize("turn", [0.0, 1e-6, 1e-3, 0.2])
def test_the_way_is_that_on_a_plane(name: str, start: float, turn: float) -> None:
    """It stops after v^2 / (2 mu g), wherever the seam is."""
    body = BODIES[name]()
    floors = [DrivenBody(Rest(position=(x, 0.0, -0.1)), (Box(0.5, 1.0, 0.1),)) for x in (-0.5, 0.5)]
    system = ns.System([*floors, body], GRAVITY)
    for floor in floors:
        system.contact(floor, body, normal=Unilateral(), friction=Coulomb(FRICTION), impact=EnergeticImpact(0.2))
    turned = ns.turned_about((0.0, 0.0, 1.0), turn)
    system.place(body, position=(start, 0.03, HALVES[2]), orientation=turned, velocity=(SPEED, 0.0, 0.0))
    solution = limited(system, 1.5)
    assert solution.status == "done", solution.message
    stop = start + SPEED**2 / (2.0 * FRICTION * GRAVITY)
    assert solution.of(body)[0][-1, :3] == pytest.approx([stop, 0.03, HALVES[2]], abs=2e-6)
