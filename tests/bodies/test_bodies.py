"""Bodies, shapes and motions: derived numbers, derivatives, starts, bad input."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bodies import Ball, Dumbbell, Harmonic, Plane, Plate, Rest, Sphere
from nonsmooth import InvalidInput, UnknownName
from nonsmooth.parameters import UnusualValue


@pytest.mark.parametrize("fraction", [0.0, 0.15, 0.6])
def test_dumbbell_inertia_from_its_parts(fraction: float) -> None:
    """Solid balls with Steiner terms and a thin rod between their surfaces, summed over slices."""
    body = Dumbbell(0.01, 3.9, 7800.0, fraction)
    r, distance, m = 0.01, body.centre_distance, body.total_mass
    assert distance == pytest.approx(2.9 * 2 * r)
    assert (distance + 2 * r) / (2 * r) == pytest.approx(3.9)
    ball = 7800.0 * 4.0 / 3.0 * math.pi * r**3
    rod = m - 2.0 * ball
    assert rod / m == pytest.approx(fraction, abs=1e-15)
    points = (np.arange(2000) + 0.5) / 2000.0 * (distance - 2 * r) - (distance / 2 - r)
    across = 2.0 * ball * (0.4 * r * r + distance**2 / 4.0) + rod * np.mean(points**2)
    along, one, other = body.inertia
    assert along == pytest.approx(2.0 * ball * 0.4 * r * r)
    assert one == other
    assert one == pytest.approx(across, rel=1e-6)


def test_ball() -> None:
    """A solid sphere."""
    ball = Ball(0.02, 1000.0)
    assert ball.total_mass == pytest.approx(4000.0 / 3.0 * math.pi * 8e-6)
    assert ball.inertia == pytest.approx((0.4 * ball.total_mass * 4e-4,) * 3)
    assert ball.shapes == (Sphere(0.02),)


def test_dumbbell_shapes() -> None:
    """Ball 1 at -l/2 and ball 2 at +l/2 on the first axis."""
    body = Dumbbell()
    half = body.centre_distance / 2.0
    assert [shape.parameters()["x"] for shape in body.shapes] == [-half, half]


@pytest.mark.slow
@given(t=st.floats(0.0, 1.0), phase=st.floats(0.1, 6.0))
def test_harmonic_motion_is_its_own_derivative(t: float, phase: float) -> None:
    """Position, velocity and acceleration belong together, along the axis, Eq. (1)."""
    motion = Harmonic(amplitude=1e-3, frequency=25.0, phase=phase, axis_x=0.6, axis_z=0.8)

    def at(time: float) -> Any:
        out = np.zeros(24)
        motion.evaluator(time, None, None, out, **motion.parameters())
        return out

    h, omega = 1e-5, 2.0 * math.pi * 25.0
    now = at(t)
    axis = np.array([0.6, 0.0, 0.8])
    np.testing.assert_allclose(now[:3], 1e-3 * math.sin(omega * t + phase) * axis, rtol=0, atol=1e-17)
    slope = (at(t + h) - at(t - h)) / (2.0 * h)
    np.testing.assert_allclose(now[12:15], slope[:3], rtol=0, atol=1e-6)
    np.testing.assert_allclose(now[18:21], slope[12:15], rtol=0, atol=1e-3)
    np.testing.assert_array_equal(now[3:12], np.eye(3).ravel())
    np.testing.assert_array_equal(now[15:18], 0.0)


@pytest.mark.parametrize("slope", [0.0, 0.3, -0.7])
def test_rest_on_a_slope(slope: float) -> None:
    """A proper rotation whose first axis points downhill for a positive slope."""
    out = np.zeros(24)
    Rest(slope).evaluator(0.0, None, None, out, **Rest(slope).parameters())
    axes = out[3:12].reshape(3, 3)
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), rtol=0, atol=1e-15)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    assert axes[2, 0] == pytest.approx(-math.sin(slope))


BAD: list[tuple[Any, dict[str, Any], tuple[str, ...]]] = [
    (Ball, {"radius": -0.01}, ("Ball.radius", "> 0", "-0.01")),
    (Ball, {"radius": math.nan}, ("Ball.radius", "finite", "nan")),
    (Ball, {"radius": 0.01, "density": 0.0}, ("Ball.density", "> 0", "0.0", "kg/m^3")),
    (Dumbbell, {"radius": 0.0}, ("Dumbbell.radius", "> 0", "radius r of the balls")),
    (Dumbbell, {"aspect_ratio": 1.5}, ("Dumbbell.aspect_ratio", ">= 2", "1.5")),
    (Dumbbell, {"rod_mass_fraction": 1.0}, ("Dumbbell.rod_mass_fraction", "<= 0.99", "1.0")),
    (Dumbbell, {"density": math.inf}, ("Dumbbell.density", "finite", "inf")),
    (Harmonic, {"amplitude": -1.0, "frequency": 25.0}, ("Harmonic.amplitude", ">= 0", "-1.0")),
    (Harmonic, {"amplitude": 1e-3, "frequency": 0.0}, ("Harmonic.frequency", "> 0", "0.0", "Hz")),
    (Harmonic, {"amplitude": 1e-3, "frequency": 25.0, "axis_x": 1.0}, ("Harmonic axis", "unit length", "Divide")),
    (Rest, {"slope": 3.0}, ("Rest.slope", "<=", "3.0", "rad")),
    (Plate, {"motion": 3.0}, ("Plate.motion", "must be a Motion", "3.0", "Harmonic")),
    (Sphere, {"radius": -1.0}, ("Sphere.radius", "> 0", "-1.0")),
    (Plane, {"height": math.nan}, ("Plane.height", "finite", "nan")),
]


@pytest.mark.parametrize(("kind", "arguments", "words"), BAD)
def test_bad_parameters(kind: Any, arguments: dict[str, Any], words: tuple[str, ...]) -> None:
    """The message names the thing, the rule and the value."""
    with pytest.raises(InvalidInput) as caught:
        kind(**arguments)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("kind", "arguments"),
    [
        (Ball, {"radius": 10.0}),
        (Ball, {"radius": 0.01, "density": 7.8}),
        (Harmonic, {"amplitude": 30.0, "frequency": 25.0}),
    ],
)
def test_unusual_parameters_warn(kind: Any, arguments: dict[str, Any]) -> None:
    """A ball of 10 m is a warning, not an error."""
    with pytest.warns(UnusualValue, match="Units are SI"):
        kind(**arguments)


STARTS: list[tuple[dict[str, Any], tuple[str, ...]]] = [
    ({"position": (0.0, 0.0)}, ("position of Ball", "3 finite numbers", "[m]")),
    ({"position": (0.0, math.nan, 0.0)}, ("position of Ball", "finite", "nan")),
    ({"velocity": (0.0, math.inf, 0.0)}, ("velocity of Ball", "finite", "[m/s]")),
    ({"angular_velocity": 3.0}, ("angular_velocity of Ball", "3 finite numbers", "[rad/s]")),
    ({"orientation": (1.0, 0.1, 0.0, 0.0)}, ("orientation of Ball", "unit quaternion", "1.00499", "Divide it")),
    ({"orientation": (0.0, 0.0, 0.0, 0.0)}, ("orientation of Ball", "unit quaternion")),
    ({"orientation": (0.1, 0.2, 0.3)}, ("scalar first: (cos(angle / 2), axis * sin(angle / 2))", "turned_about")),
    ({"velocty": (1.0, 0.0, 0.0)}, ("start of Ball: unknown keyword", "Did you mean 'velocity'?")),
]


@pytest.mark.parametrize(("start", "words"), STARTS)
def test_bad_starts(start: dict[str, Any], words: tuple[str, ...]) -> None:
    """A start of a wrong shape, with a wrong number or without a unit quaternion is refused."""
    with pytest.raises(InvalidInput) as caught:
        Ball(0.01).state(**start)
    for word in words:
        assert word in str(caught.value)


def test_unknown_start_suggests() -> None:
    """A misspelt word is answered with the nearest."""
    with pytest.raises(UnknownName, match="Did you mean 'velocity'"):
        Ball(0.01).state(velocty=(0, 0, 0))


def test_a_driven_body_cannot_be_placed() -> None:
    """Its motion says where it is."""
    with pytest.raises(InvalidInput, match="says where it is"):
        Plate().state(position=(0, 0, 1))


def test_a_quaternion_is_stored_at_unit_length() -> None:
    """What is accepted within 1e-9 is normalised."""
    q, _ = Ball(0.01).state(orientation=(1.0 + 5e-10, 0.0, 0.0, 0.0))
    assert np.linalg.norm(q[3:]) == pytest.approx(1.0, abs=1e-16)
