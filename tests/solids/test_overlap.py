"""How deep convex sets overlap, and how far they are apart: proofs either way, and closed forms."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from bodies import Box, Cone, Disc, Point, Sphere
from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector
from nonsmooth.solids.pieces import Pieces
from nonsmooth.solids.placed import Placed, measured_hulls, overlap
from tests.solids.depth import penetration
from tests.solids.kinds import KINDS, angle
from tests.solids.separation import nearest, piece_of

CONVEX = sorted(set(KINDS) - {"angle"})


def _placed(shape: Shape, position: object = (0.0, 0.0, 0.0), rotation: Vector | None = None) -> Placed:
    pieces = Pieces.of(shape)
    assert pieces is not None
    return Placed(pieces, np.array(position, dtype=float), np.eye(3) if rotation is None else rotation)


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("pair", list(itertools.combinations_with_replacement(CONVEX, 2)), ids="-".join)
def test_one_of_two_proofs_holds(pair: tuple[str, str]) -> None:
    """Sets in random poses are apart by a plane, or overlap by a ball of differences; the direction shows it."""
    rng = np.random.default_rng(4)
    for distance in (0.0, 0.008, 0.014, 0.02, 0.05):
        turns, way = Rotation.random(2, random_state=rng).as_matrix(), rng.normal(size=3)
        shapes = [KINDS[kind](rng).frames[0][0] for kind in pair]
        places = np.zeros(3), distance * way / np.linalg.norm(way)
        one, two = (piece_of(*each) for each in zip(shapes, places, turns, strict=True))
        found = measured_hulls(*(_placed(*each) for each in zip(shapes, places, turns, strict=True)))
        deep, apart, normal = -found.upper, found.separation, found.normal
        assert (deep > 0.0) != (apart > 0.0)
        between = float(normal @ (two.support(-normal) - one.support(normal)))
        assert between == pytest.approx(apart, rel=1e-12)
        ways = rng.normal(size=(200, 3))
        if apart > 0.0:
            # nowhere more: the distance along any other direction is less
            others = [float(n @ (two.support(-n) - one.support(n))) / np.linalg.norm(n) for n in ways]
            assert max(others) <= apart * (1.0 + 1e-12)
            assert apart == pytest.approx(nearest(one, two, 1e-14).lower, abs=1e-12)
        else:
            # no worse than the expanding polytope in Python
            reference = penetration(one, two, 1e-12)
            assert reference is not None
            assert reference.lower * (1.0 - 1e-9) <= -apart <= reference.upper * (1.0 + 1e-9)
            assert all(float(n @ (one.support(n) - two.support(-n))) >= deep * np.linalg.norm(n) for n in ways)


@pytest.mark.parametrize("gap", [1e-8, -1e-8])
@pytest.mark.parametrize("way", [(0.0, 0.0, 1.0), (0.6, 0.0, 0.8), (0.36, 0.48, 0.8)])
def test_balls_overlap_by_their_distance(way: tuple[float, ...], gap: float) -> None:
    """Both sides of a tolerance of 2e-9 m."""
    one, two = _placed(Sphere(0.01)), _placed(Sphere(0.02), (0.03 + gap) * np.array(way))
    found = overlap(one, two, 2e-9)
    assert found == 0.0 if gap > 0.0 else 9e-9 < found <= 1.001e-8


@pytest.mark.parametrize("off", [(0.0, 0.0, 0.02), (0.02, 0.02, 0.0), (0.02, 0.02, 0.02), (0.003, -0.004, 0.02)])
def test_boxes_may_touch(off: tuple[float, float, float]) -> None:
    """With faces, edges and vertices in one plane, not deeper than a tolerance."""
    box = Box(0.01, 0.01, 0.01)
    inwards = -np.sign(off) * np.isclose(np.abs(off), 0.02)
    for deep, allowed in ((0.0, True), (0.9e-8, True), (1.1e-8, False)):
        found = overlap(_placed(box), _placed(box, np.array(off) + deep * inwards), 1e-8)
        assert (found == 0.0) is allowed


def test_what_has_no_thickness_pierces_and_touches() -> None:
    """Discs through each other and a point in a cone overlap; a disc on a face, discs in a plane and an apex do not."""
    disc, quarter = Disc(0.01), Rotation.from_rotvec([0.5 * np.pi, 0.0, 0.0]).as_matrix()
    assert overlap(_placed(disc), _placed(disc, (0.002, 0.003, 0.0), quarter), 1e-8) > 5e-3
    assert overlap(_placed(disc), _placed(disc, (0.002, 0.003, 0.0)), 1e-8) == 0.0
    assert overlap(_placed(disc), _placed(disc, (0.002, 0.0, 0.01), quarter), 1e-8) == 0.0
    assert overlap(_placed(disc, (0.0, 0.0, 0.01)), _placed(Box(0.02, 0.02, 0.01)), 1e-8) == 0.0
    cone = _placed(Cone(0.01, 0.02))
    assert overlap(cone, _placed(Point(0.0, 0.0, 0.0201)), 1e-8) == 0.0
    assert overlap(cone, _placed(Point(0.0, 0.0, 0.0199)), 1e-8) == pytest.approx(1e-4 / np.sqrt(5.0), rel=0.1)


def test_what_is_inside_of_a_surface_overlaps() -> None:
    """A ball in an L without a crossing, an L in its own place, and beside each other; none in the L's corner."""
    (mesh,) = angle(0.01).frames[0]
    arm, corner = np.array([0.01, -0.0075, 0.0]), np.array([0.01, 0.01, 0.0])
    arm[:2] -= _centre(mesh)
    corner[:2] -= _centre(mesh)
    assert overlap(_placed(mesh), _placed(Sphere(0.004), arm), 1e-8) > 0.0
    assert overlap(_placed(Sphere(0.004), arm), _placed(mesh), 1e-8) > 0.0
    assert overlap(_placed(mesh), _placed(Sphere(0.004), corner), 1e-8) == 0.0
    assert overlap(_placed(mesh), _placed(mesh), 1e-8) > 0.0
    assert overlap(_placed(mesh), _placed(mesh, (0.0, 0.0, 0.01)), 1e-8) == 0.0
    assert overlap(_placed(mesh), _placed(mesh, (0.0, 0.0, 0.01 - 1e-7)), 1e-8) > 0.0


def _centre(mesh: Shape) -> Vector:
    """Return where the mass centre of an L of 1 cm is in its own axes, whose zero is a quarter from its square [m]."""
    assert mesh.solid is not None
    low, _ = mesh.solid.bounds
    return np.array([-0.0125, -0.0125]) - low[:2]
