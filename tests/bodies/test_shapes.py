"""Shapes: the farthest point, and what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from bodies import Box, Capsule, Cylinder, Disc, Ellipsoid
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
    assert Capsule(0.3, 0.2, *center, **AXIS).length == pytest.approx(0.3 + farthest(caps))


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
