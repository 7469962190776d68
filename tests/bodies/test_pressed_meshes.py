"""Bodies pressed into meshes: a corner of a body in an inner corner of a mesh is pressed into both of its walls."""

from __future__ import annotations

import numpy as np
import pytest

import nonsmooth as ns
from bodies import BoxBody, MeshBody, Triangles
from laws import Frictionless, LinearCompliant
from nonsmooth.interfaces import Body
from tests.bodies.listed import listed
from tests.bodies.meshes import parts

SIDE = 0.005
"""Of the cube [m]."""
CUBES = {
    "box": BoxBody(0.5 * SIDE, 0.5 * SIDE, 0.5 * SIDE),
    "mesh": MeshBody(Triangles(*(part.tolist() for part in parts.box(SIDE, SIDE, SIDE)))),
    "L": MeshBody(Triangles(*(part.tolist() for part in parts.bracket(SIDE)))),
}
DEPTHS = (1e-12, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4)


def _pressed(body: Body, place: tuple[float, float, float]) -> list[tuple[tuple[int, ...], float]]:
    """Return normals and gaps of the contacts of a body at a place with an L, whose inner corner is at the origin."""
    mesh = MeshBody(Triangles(*(part.tolist() for part in parts.bracket())))
    system = ns.System([mesh, body], gravity=0.0)
    system.contact(mesh, body, normal=LinearCompliant(1e4, 1.0), friction=Frictionless())
    system.place(mesh, position=tuple(np.array(mesh.centre) - [0.01, 0.01, 0.5 * 0.015]))
    system.place(body, position=place)
    found = listed(system)
    near = found.within & (found.gap < 0.1 * SIDE)
    return [
        (tuple(np.round(n).astype(int)), float(g)) for n, g in zip(found.normal[near], found.gap[near], strict=True)
    ]


@pytest.mark.parametrize("name", ["box", "mesh"])
@pytest.mark.parametrize("floor", DEPTHS)
@pytest.mark.parametrize("wall", DEPTHS)
def test_a_cube_in_an_inner_corner_is_pressed_into_both_walls(wall: float, floor: float, name: str) -> None:
    """With the four corners of either face, at the depth of the face."""
    contacts = _pressed(CUBES[name], (0.5 * SIDE - wall, 0.5 * SIDE - floor, 0.0))
    for normal, depth in (((1, 0, 0), wall), ((0, 1, 0), floor)):
        gaps = [gap for n, gap in contacts if n == normal]
        assert gaps == pytest.approx([-depth] * 4, abs=1e-14)
    assert len(contacts) == 8


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("shift", [1e-7, 1e-6, 1e-5])
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_flush_faces_have_the_corners_of_their_overlap(sign: float, shift: float, depth: float) -> None:
    """Two equal Ls on each other, shifted along both sides by more than round-off, at any depth."""
    mesh = parts.bracket()
    one, two = (MeshBody(Triangles(*(part.tolist() for part in mesh))) for _ in range(2))
    system = ns.System([one, two], gravity=0.0)
    system.contact(one, two, normal=LinearCompliant(1e4, 1.0), friction=Frictionless())
    system.place(two, position=(shift, 0.5 * sign * shift, 0.015 - depth))
    found = listed(system)
    near = found.within & (found.gap < 1e-3)
    points = np.unique(found.first[near][:, :2].round(12), axis=0)
    np.testing.assert_allclose(found.gap[near], -depth, rtol=0, atol=1e-14)
    np.testing.assert_allclose(found.normal[near] - [0.0, 0.0, 1.0], 0.0, rtol=0, atol=1e-9)
    # the outline of the overlap of two Ls has a convex corner in place of the inner one if they are shifted to it
    expected = 5 if sign > 0.0 else 6
    assert len(points) == expected
