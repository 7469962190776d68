"""Shapes: the farthest point, and what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from bodies import Box, Capsule, Compound, Cone, Cylinder, CylinderBody, Disc, DiscBody, Ellipsoid, Part
from bodies.shapes.frustum import LEAST
from nonsmooth import InvalidInput

CENTERS = [(0.0, 0.0, 0.0), (0.1, -0.2, 0.05), (0.0, 0.0, 0.3)]
AXIS = {"axis_x": 0.48, "axis_y": -0.6, "axis_z": 0.64}
AXES = {"orientation_w": 0.8, "orientation_x": 0.36, "orientation_y": -0.48}
QUATERNION = [0.36, -0.48, 0.0, 0.8]


def _farthest_on_ellipsoid(semi: Any, center: Any, axes: Any) -> float:
    """Climb from many points of the surface."""

    def nearness(angles: Any) -> float:
        a, b = angles
        v = np.array([np.cos(a) * np.sin(b), np.sin(a) * np.sin(b), np.cos(b)])
        return -float(np.linalg.norm(center + axes @ (semi * v)))

    starts = np.random.default_rng(1).uniform(0.0, 2.0 * np.pi, (20, 2))
    return -min(float(minimize(nearness, start, tol=1e-12).fun) for start in starts)


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("center", CENTERS)
@pytest.mark.parametrize("semi", [(0.1, 0.2, 0.4), (0.3, 0.3, 0.1), (0.2, 0.2, 0.2), (0.4, 0.3, 0.1)])
@pytest.mark.parametrize("turned", [False, True])
def test_length_of_an_ellipsoid(center: Any, semi: Any, turned: bool) -> None:
    """The farthest point, also where the centre stands across the longest axis."""
    axes = Rotation.from_quat(QUATERNION).as_matrix() if turned else np.eye(3)
    shape = Ellipsoid(*semi, *center, **(AXES if turned else {}))
    assert shape.length == pytest.approx(_farthest_on_ellipsoid(np.array(semi), np.array(center), axes), abs=1e-9)


@pytest.mark.parametrize("center", CENTERS)
def test_lengths_of_shapes_with_an_axis(center: Any) -> None:
    """Against points sampled on rims and end spheres."""
    axis = np.array([0.48, -0.6, 0.64])
    u = np.cross(axis, [1.0, 0.0, 0.0])
    u /= np.linalg.norm(u)
    angles = np.linspace(0.0, 2.0 * np.pi, 100001)[:, None]
    rim = 0.3 * (np.cos(angles) * u + np.sin(angles) * np.cross(axis, u))
    at = np.array(center)

    def farthest(points: Any) -> float:
        return float(np.max(np.linalg.norm(points, axis=-1)))

    assert Disc(0.3, *center, **AXIS).length == pytest.approx(farthest(at + rim), abs=1e-9)
    caps = [at + sign * 0.2 * axis for sign in (-1.0, 1.0)]
    assert Cylinder(0.3, 0.2, *center, **AXIS).length == pytest.approx(max(farthest(c + rim) for c in caps), abs=1e-9)
    cone = Cone(0.3, 0.2, *center, **AXIS)
    np.testing.assert_allclose(cone.apex, at + 0.2 * axis, rtol=0, atol=1e-15)
    assert cone.length == pytest.approx(max(farthest(at + rim), farthest(at + 0.2 * axis)), abs=1e-9)
    assert Capsule(0.3, 0.2, *center, **AXIS).length == pytest.approx(0.3 + farthest(caps))


@pytest.mark.parametrize(
    "axis", [(0.0, 0.0, 1.0), (0.48, -0.6, 0.64), (0.0, 1.0, 0.0), (0.0, -1.0, 0.0), (-1.0, 0.0, 0.0)]
)
def test_feet_stand_on_both_faces(axis: Any) -> None:
    """Three on either, a third of a turn apart, at two thirds of the radius; a cylinder is as long as without."""
    direction = np.array(axis)
    axes: dict[str, Any] = dict(zip(("axis_x", "axis_y", "axis_z"), axis, strict=True))
    place: dict[str, Any] = {"x": 0.1, "y": -0.2, "z": 0.05, **axes}
    center = np.array([0.1, -0.2, 0.05])
    disc, cylinder = Disc(0.3, **place, foot_height=0.02), Cylinder(0.3, 0.2, **place, foot_height=0.02)
    for shape, height in ((disc, 0.02), (cylinder, 0.2)):
        feet = np.array(shape.feet) - center
        np.testing.assert_allclose(feet @ direction, [-height] * 3 + [height] * 3, rtol=0, atol=1e-15)
        for face in (feet[:3], feet[3:]):
            across = face - np.outer(face @ direction, direction)
            products = across @ across.T / 0.2**2
            np.testing.assert_allclose(products, 1.5 * np.eye(3) - 0.5, rtol=0, atol=1e-14)
    rims = np.array(cylinder.rims) - center
    np.testing.assert_allclose(rims, [-0.18 * direction, 0.18 * direction], rtol=0, atol=1e-15)
    cone = Cone(0.3, 0.2, **place, foot_height=0.02)
    np.testing.assert_allclose(cone.feet, np.array(disc.feet[:3]) + 0.02 * direction, rtol=0, atol=1e-15)
    # the rim is set back along the side
    (radius, rim), (none, apex) = cone.standing_rims
    assert (radius, none) == pytest.approx((0.27, 0.0), abs=1e-15)
    np.testing.assert_allclose([rim, apex], [center + 0.02 * direction, center + 0.2 * direction], rtol=0, atol=1e-15)
    plain = Cylinder(0.3, 0.2, **place)
    low = 0.2 - LEAST * 0.3
    np.testing.assert_allclose(np.array(plain.rims) - center, [-low * direction, low * direction], rtol=0, atol=1e-15)
    assert plain.feet == cylinder.feet
    assert plain.caps == cylinder.caps


def test_usual_feet() -> None:
    """A ten-thousandth of the radius, less on a cylinder that is hardly longer than that, the least on request."""
    heights = [
        shape.foot_height  # type: ignore[attr-defined]
        for body in (DiscBody(0.5), CylinderBody(0.5, 0.1), CylinderBody(0.5, 1e-5), DiscBody(0.5, foot_height=0.0))
        for shape in body.shapes
    ]
    assert heights == pytest.approx([5e-5, 5e-5, 1e-6, 0.0], rel=1e-12, abs=0.0)
    (moved,) = Compound((Part(CylinderBody(0.5, 0.1), (1.0, 2.0, 3.0), (0.6, 0.8, 0.0, 0.0)),)).shapes
    assert moved.foot_height == 5e-5  # type: ignore[attr-defined]


@pytest.mark.parametrize("center", CENTERS)
def test_length_of_a_box(center: Any) -> None:
    """Its farthest vertex."""
    signs = np.array(np.meshgrid(*[[-1.0, 1.0]] * 3)).reshape(3, -1).T
    vertices = np.array(center) + signs * [0.1, 0.2, 0.3] @ Rotation.from_quat(QUATERNION).as_matrix().T
    box = Box(0.1, 0.2, 0.3, *center, **AXES)
    assert box.length == pytest.approx(float(np.max(np.linalg.norm(vertices, axis=1))))
    found = np.array(sorted(box.vertices))
    np.testing.assert_allclose(found, np.array(sorted(map(tuple, vertices))), rtol=0, atol=1e-15)


BAD: list[tuple[Any, dict[str, Any], tuple[str, ...]]] = [
    (Box, {"half_x": 0.1, "half_y": 0.0, "half_z": 0.1}, ("Box.half_y", "> 0", "0.0")),
    (Box, {"half_x": 1, "half_y": 1, "half_z": 1, "orientation_x": 0.1}, ("Box orientation", "unit length", "Divide")),
    (Capsule, {"radius": 0.1, "half_length": -0.1}, ("Capsule.half_length", "> 0", "-0.1")),
    (Capsule, {"radius": 0.1, "half_length": 0.1, "axis_x": 1.0}, ("Capsule axis", "unit length", "1.41421")),
    (Cylinder, {"radius": 0.1, "half_length": 0.1, "axis_z": 0.0}, ("Cylinder axis", "unit length")),
    (Disc, {"radius": 0.1, "axis_y": 1.0}, ("Disc axis", "unit length")),
    (Disc, {"radius": 0.1, "foot_height": -1e-5}, ("Disc.foot_height", ">= 0", "-1e-05")),
    (Disc, {"radius": 0.1, "foot_height": 0.011}, ("Disc.foot_height", "at most a tenth of the radius, 0.01", "0.011")),
    (DiscBody, {"radius": 0.1, "foot_height": 0.1}, ("DiscBody.foot_height", "at most a tenth", "a ten-thousandth")),
    (
        CylinderBody,
        {"radius": 0.1, "half_length": 1e-3, "foot_height": 1e-3},
        ("CylinderBody.foot_height", "less than half the length, 0.001", "0.001", "set back"),
    ),
    (Ellipsoid, {"semi_x": 0.1, "semi_y": 0.1, "semi_z": 0.0}, ("Ellipsoid.semi_z", "> 0")),
    (
        Ellipsoid,
        {"semi_x": 1, "semi_y": 1, "semi_z": 1, "orientation_w": 0.5},
        ("Ellipsoid orientation", "unit length"),
    ),
]


@pytest.mark.parametrize(("kind", "arguments", "words"), BAD)
def test_bad_parameters(kind: Any, arguments: dict[str, Any], words: tuple[str, ...]) -> None:
    """The message names the thing, the rule and the value."""
    with pytest.raises(InvalidInput) as caught:
        kind(**arguments)
    for word in words:
        assert word in str(caught.value)
