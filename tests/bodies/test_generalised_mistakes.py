"""Bodies in generalised coordinates with one mistake each: refused by name, before anything runs."""

from __future__ import annotations

import math
from typing import Any

import pytest

import nonsmooth as ns
from bodies import Coordinate, GeneralisedBody, Point, PointFrame, TurningFrame
from nonsmooth.types import Floats
from tests.bodies.planar_functions import END, PART, gyroscopic, no_power, rigid_mass, weight_force, weight_potential


def _too_far(q: Floats, out: Floats, weight: float, inertia: float) -> None:
    out[0] = out[4] = weight
    out[8] = out[9] = inertia


def _not_a_number(t: float, q: Floats, u: Floats, out: Floats, weight: float) -> None:
    out[1] = math.nan * weight


def _beyond(q: Floats, weight: float, gravity_z: float) -> float:
    return -weight * gravity_z * q[3]


def _upwards(t: float, q: Floats, u: Floats, out: Floats, weight: float, gravity_z: float) -> None:
    out[1] = -weight * gravity_z


def _wrong_turn(q: Floats, out: Floats) -> None:
    out[0] = out[7] = 1.0
    out[14] = 1.0


def _skewed(q: Floats, out: Floats) -> None:
    out[0], out[2] = q[0], q[1]
    out[3] = out[7] = 1.0
    out[11] = 1.01


def _wrong_sign(q: Floats, out: Floats, half: float) -> None:
    out[0] = out[7] = 1.0
    out[2], out[8] = half * math.sin(q[2]), half * math.cos(q[2])


def _half_bias(q: Floats, u: Floats, out: Floats, half: float) -> None:
    out[0], out[2] = -0.5 * half * math.cos(q[2]) * u[2] ** 2, -0.5 * half * math.sin(q[2]) * u[2] ** 2


def _misspelt(q: Floats, out: Floats, halv: float) -> None:
    out[0] = halv


def _no_square(q: Floats, u: Floats, out: Floats, half: float) -> None:
    out[0], out[2] = -half * math.cos(q[2]) * u[2], -half * math.sin(q[2]) * u[2]


MISTAKES: list[tuple[dict[str, Any], tuple[str, ...]]] = [
    ({"mass": _too_far}, ("mass: _too_far", "must write 9 numbers")),
    ({"force": _not_a_number}, ("force: _not_a_number", "finite", "nan")),
    ({"potential": _beyond}, ("potential: _beyond", "finite", "index beyond")),
    ({"force": _upwards}, ("force: _upwards", "Lagrange's equations: entry [1] should be -19", "signs")),
    ({"force": gyroscopic}, ("force: gyroscopic", "Lagrange's equations", "give their power")),
    ({"force": _upwards, "power": no_power}, ("force: _upwards", "power 0 W beside that of the potential")),
    ({"part": {"jacobian": _wrong_turn}}, ("moving_frames[1].jacobian: _wrong_turn", "derivative of the rotation")),
    ({"part": {"pose": _skewed}}, ("moving_frames[1].pose: _skewed", "rotation matrix", "right-handed")),
    ({"end": {"jacobian": _wrong_sign}}, ("moving_frames[0].jacobian: _wrong_sign", "derivative of the position")),
    ({"end": {"bias": _half_bias}}, ("moving_frames[0].bias: _half_bias", "derivative of the Jacobian times u")),
    ({"end": {"bias": _no_square}}, ("moving_frames[0].bias: _no_square", "derivative of the Jacobian times u")),
    ({"end": {"pose": _misspelt}}, ("_misspelt: unknown constant", "'halv'", "Did you mean 'half'")),
    ({"mass": weight_force}, ("mass: weight_force", "must begin with ('q', 'out')")),
    ({"potential": 3.0}, ("potential", "plain function", "3.0")),
    ({"coordinates": ()}, ("coordinates", "at least one")),
    (
        {"coordinates": (Coordinate("x", "m"), Coordinate("x", "m"), Coordinate("z", "m"))},
        ("coordinates", "another name"),
    ),
    ({"coordinates": "xza"}, ("coordinates", "tuple of Coordinate")),
    ({"moving_frames": Point()}, ("moving_frames", "tuple of MovingFrame")),
    ({"constants": {"gravity_z": 1.0}}, ("constants['gravity_z']", "variable of its own")),
    ({"constants": {"half": "wide"}}, ("constants['half']", "finite number", "'wide'")),
]


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize(("mistake", "words"), MISTAKES, ids=[f"{words[0]}, {words[1]}" for _, words in MISTAKES])
def test_mistakes_are_named(mistake: dict[str, Any], words: tuple[str, ...]) -> None:
    """The message names the function, the rule, the value and the remedy, before anything runs."""
    mistake = dict(mistake)
    frames = PointFrame(**(END | mistake.pop("end", {}))), TurningFrame(**(PART | mistake.pop("part", {})))
    good: dict[str, Any] = {
        "coordinates": tuple(Coordinate(name, "m") for name in "xza"),
        "mass": rigid_mass,
        "force": weight_force,
        "potential": weight_potential,
        "moving_frames": frames,
        "constants": {"weight": 2.0, "inertia": 0.1, "half": 0.5},
    }
    with pytest.raises(ns.InvalidInput) as caught:
        ns.System([GeneralisedBody(**(good | mistake))])
    for word in words:
        assert word in str(caught.value)
