"""Kinematics of two spheres with one fault each."""

from __future__ import annotations

import math
from typing import Any

from bodies import Sphere, SphereSphere
from nonsmooth.compiled import compiled
from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape
from nonsmooth.types import Floats

FIRST, SECOND = Sphere(0.2, x=0.1), Sphere(0.3, y=-0.05)
_sound: Any = compiled(SphereSphere.between(FIRST, SECOND)[0].evaluator)
FAULTS = {
    "writes its block": 1.0,
    "axes": 2.0,
    "witness points": 3.0,
    "feature": 4.0,
    "gap rate": 5.0,
    "second-order terms": 6.0,
    "tangent follows the first body": 7.0,
    "frame invariance": 8.0,
}
"""Faults by the property made for them."""
BEYOND = 20.0


def evaluate(a: Floats, b: Floats, out: Floats, fault: float) -> None:
    left = out[14]
    _sound(a, b, out, 0.2, 0.1, 0.0, 0.0, 0.3, 0.0, -0.05, 0.0)
    if fault == 1.0 and out[0] <= 0.0:
        # what another contact left there
        out[14] = left + 1e-9
    if fault == 2.0:
        for i in range(3):
            out[4 + i] = 1.0001 * out[4 + i]
    if fault == 3.0:
        out[10] = out[10] + 1e-8
    if fault == 4.0:
        out[29] = 1.0
    if fault == 5.0:
        out[0] = 1.1 * out[0]
    if fault == 6.0:
        out[25] = 2.0 * out[25]
    if fault == 7.0:
        # a tangent next to the x axis of the world
        x, y, z = 1.0 - out[1] * out[1], -out[1] * out[2], -out[1] * out[3]
        length = math.sqrt(x * x + y * y + z * z)
        out[4], out[5], out[6] = x / length, y / length, z / length
    if fault == 20.0:
        out[31] = 0.0
    if fault == 8.0:
        shift = 3e-9 * a[0]
        out[0] = out[0] + shift
        for i in range(3):
            out[10 + i] = out[10 + i] + shift * out[1 + i]


class Pair(ContactKinematics):
    """Two spheres: a contact without a fault, then one of each fault."""

    pair = (Sphere, Sphere)

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        return tuple(
            FeaturePair(evaluate, {"fault": fault}, ("sphere-sphere",)) for fault in (0.0, *FAULTS.values(), BEYOND)
        )


DUMMIES: list[tuple[str, int]] = [(name, 1 + number) for number, name in enumerate([*FAULTS, "writes its block"])]
"""Property and number of the contact that breaks it."""
