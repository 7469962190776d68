"""Conformance checks of prescribed motions: derivatives, continuity and time scale.

Each claim states a property in its docstring. It returns or raises a message if the property fails, else "" or None.
"""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np

from nonsmooth.engine.memory.blocks import ACCELERATION, FRAME, POSITION, ROTATION, SPIN, SPIN_ACCELERATION, VELOCITY
from nonsmooth.interfaces import Motion
from nonsmooth.testing.claims import GIVEN, Claims, claim, rows
from nonsmooth.testing.differences import jump, rotation_fault, slope, slope_fault, spin_of
from nonsmooth.testing.functions import CheckedFunction, all_rows, left_over, plain_caller, written
from nonsmooth.testing.inputs import draws, number
from nonsmooth.testing.outcome import Broken, NotChecked, Row
from nonsmooth.testing.property import Property, properties
from nonsmooth.types import Array

_DRAWS = 40
_SPAN = 3.0
"""Time for which a motion is checked by default, in units of its time scale."""
_STEP = 1e-3
"""Step of the differences, in units of the time scale."""
_ELSEWHEN = 0.637
"""Time between an input and a second input that is evaluated before it, in units of the time scale. If the motion does
not write a number of its block at the input, the number from the second input remains and shows."""
_PIECES, _BENT = 16, 0.15
"""Check of the declared time scale: the number of pieces into which the time scale is cut, and the largest deviation of
a value from a straight line within a piece, relative to the value's size. A sine with a period of a third of the time
scale deviates more. So a motion with such a sine fails the check: its time scale is too long."""
_PARTS = {
    "position": slice(POSITION, ROTATION),
    "rotation": slice(ROTATION, VELOCITY),
    "velocity": slice(VELOCITY, SPIN),
    "angular velocity": slice(SPIN, ACCELERATION),
    "acceleration": slice(ACCELERATION, SPIN_ACCELERATION),
    "angular acceleration": slice(SPIN_ACCELERATION, FRAME),
}
_NOTHING = np.zeros(1)
"""Dummy array for q and u, as a driven body has no coordinates."""
_MOTION = Claims()


def check_motion(motion: Motion, *, duration: float | None = None) -> list[Property]:
    """Return the properties of a prescribed motion.

    Parameters
    ----------
    motion : Motion
        The motion.
    duration : float, optional
        Time for which the motion is checked, from t = 0 [s]; by default three times its time scale, or 1 s if the time
        scale is infinite.
    """
    return properties(motion, _rows, duration=duration)


def _rows(motion: Motion, duration: float | None) -> list[Row]:
    span = duration or (_SPAN * _unit(motion) if math.isfinite(motion.time_scale) else 1.0)
    table = functools.partial(rows, components=lambda: [motion], count=_DRAWS, given=[number("t", 0.0, span)])
    found = [
        *table(_MOTION),
        Row("no jumps", "Pose, velocities and accelerations are continuous", lambda: _check_jumps(motion, span)),
        Row(
            "time scale",
            "Over a sixteenth of the time scale the motion is nearly straight",
            lambda: _check_scale(motion, span),
        ),
    ]
    return all_rows(motion, lambda: [_evaluator(motion, span)], found, table([_positive_time_scale]))


def _evaluator(motion: Motion, span: float) -> CheckedFunction:
    times = [case["t"] for case in draws([number("t", 0.0, span)], 8)]
    inputs = [(f"t = {t:.3g}", (t, _NOTHING, _NOTHING)) for t in times]
    return CheckedFunction(motion, "evaluator", "body", motion.parameters(), inputs, FRAME)


def _call(motion: Motion, t: float, out: Array) -> Any:
    plain_caller(motion.evaluator, "body", motion.parameters())(t, _NOTHING, _NOTHING, out)


def _look(motion: Motion, t: float) -> Array:
    return written(functools.partial(_call, motion, t), FRAME)[:FRAME]


def _unit(motion: Motion) -> float:
    """Return the time scale of a motion [s]; 1 s if the time scale is infinite or not positive."""
    scale = float(motion.time_scale)
    return scale if math.isfinite(scale) and scale > 0.0 else 1.0


@claim()
def _positive_time_scale(motion: Motion) -> None:
    """The time scale of the motion is positive."""
    if not motion.time_scale > 0.0:
        raise Broken("it must be positive [s], or infinite", "time_scale", motion.time_scale)


@_MOTION.claim(GIVEN)
def _writes_its_block(motion: Motion, t: float) -> str:
    """A call of the motion writes every number of the frame's block that is not always zero, and nothing outside."""
    before = abs(t - _ELSEWHEN * _unit(motion))
    return left_over(functools.partial(_call, motion, t), functools.partial(_call, motion, before), FRAME)


@_MOTION.claim(GIVEN)
def _rotation(motion: Motion, t: float) -> str:
    """The axes that the motion gives are a rotation matrix."""
    return rotation_fault(_look(motion, t)[_PARTS["rotation"]])


def _slope(motion: Motion, t: float, part: str) -> tuple[Array, float]:
    return slope(lambda dt: _look(motion, t + dt)[_PARTS[part]], _STEP * _unit(motion))


def _slope_fault(motion: Motion, t: float, part: str, found: Array, known: float) -> str:
    return slope_fault(part, _look(motion, t)[_PARTS[part]], found, known)


@_MOTION.claim(GIVEN)
def _velocity(motion: Motion, t: float) -> str:
    """Velocity and angular velocity are the time derivatives of position and rotation."""
    rates, known = _slope(motion, t, "rotation")
    spin = spin_of(rates, _look(motion, t)[_PARTS["rotation"]])
    moves = _slope_fault(motion, t, "velocity", *_slope(motion, t, "position"))
    return moves or _slope_fault(motion, t, "angular velocity", spin, known)


@_MOTION.claim(GIVEN)
def _acceleration(motion: Motion, t: float) -> str:
    """Acceleration and angular acceleration are the time derivatives of velocity and angular velocity."""
    moves = _slope_fault(motion, t, "acceleration", *_slope(motion, t, "velocity"))
    return moves or _slope_fault(motion, t, "angular acceleration", *_slope(motion, t, "angular velocity"))


def _check_jumps(motion: Motion, span: float) -> None:
    for name, part in _PARTS.items():
        found = jump(lambda t, part=part: _look(motion, t)[part], 0.0, span, 256)  # type: ignore[misc]
        if found is not None:
            raise Broken(f"the {name} jumps by {found[1].tolist()}", case={"t": found[0]})


def _check_scale(motion: Motion, span: float) -> None:
    scale = float(motion.time_scale)
    if not scale > 0.0:
        raise NotChecked("not checked, as the time scale is not positive")
    piece = min(scale, span) / _PIECES
    blocks = np.array([_look(motion, t) for t in np.arange(0.0, span + piece, 0.5 * piece)])
    for name, part in _PARTS.items():
        values = blocks[:, part]
        size = float(np.max(np.abs(values)))
        if name == "position":
            continue  # a motion without a time scale may be uniform: its position changes, but its velocity is constant
        if not math.isfinite(scale):
            if np.max(np.abs(values - values[0])) > 1e-9 * size:
                raise Broken(f"the {name} changes", "time_scale", scale)
            continue
        bent = np.max(np.abs(values[1:-1] - 0.5 * (values[:-2] + values[2:])), axis=1) / max(size, 1e-300)
        if np.max(bent) > _BENT:
            when = 0.5 * piece * (1 + int(np.argmax(bent)))
            words = f"within {piece:g} s the {name} departs by {np.max(bent):.0%} of its size from a straight line"
            raise Broken(words, "time_scale", scale, {"t": when})
