"""Properties of prescribed motions."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.interfaces import Motion
from nonsmooth.testing import moving
from nonsmooth.testing.callers import compiled_caller, plain_caller
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.draws import Case, Variable, draws
from nonsmooth.testing.examine import Trial, examine
from nonsmooth.testing.functions import OLD, ROOM, Function, Functions
from nonsmooth.testing.jumps import jump
from nonsmooth.testing.moving import Array
from nonsmooth.testing.property import Broken, NotChecked, Property, Row, properties

_DRAWS = 40
_SAME = 1e-6
_LOOKED_AT = 3.0
"""How long a motion is looked at by default, in units of its time scale."""
_STEP = 1e-3
"""Step of the differences, in units of the time scale."""
_PIECES, _BENT = 16, 0.15
"""Over 1/16 of the time scale everything is straight to 15 %: a sine of a third of the time scale is not."""
_PARTS = (
    ("rotation", slice(3, 12)),
    ("velocity", slice(12, 15)),
    ("angular velocity", slice(15, 18)),
    ("acceleration", slice(18, 21)),
    ("angular acceleration", slice(21, 24)),
)
_NOTHING = np.zeros(1)


def check_motion(motion: Motion, *, duration: float | None = None) -> list[Property]:
    """Return the properties of a prescribed motion.

    Parameters
    ----------
    motion : Motion
        The motion.
    duration : float, optional
        How long it is looked at, from t = 0 [s]; by default three times its time scale, a second if that is infinite.
    """

    def span() -> float:
        return duration or (_LOOKED_AT * _unit(motion) if math.isfinite(motion.time_scale) else 1.0)

    functions = Functions(lambda: [_evaluator(motion, span())])

    def row(name: str, says: str, trial: Trial) -> Row:
        return name, says, lambda: examine(name, [motion], [Variable("t", 0.0, span())], trial, _DRAWS)

    rows = [
        row("writes its block", "it writes every number that can be non-zero, and nothing beyond the block", _writes),
        row("rotation", "the axes are a rotation matrix", _rotation),
        row("velocity", "velocity and angular velocity are the derivatives of the pose, by differences", _velocity),
        row("acceleration", "the accelerations are the derivatives of the velocities, by differences", _acceleration),
        ("no jumps", "pose, velocities and accelerations are continuous", lambda: _check_jumps(motion, span())),
        ("time scale", "it changes no faster than its time scale says", lambda: _check_scale(motion, span())),
    ]
    scale: list[Row] = [("positive time scale", "its time scale is positive", lambda: _check_positive(motion))]
    return properties(motion, [*component_rows(motion), *scale, *functions.rows(), *functions.guarded(rows)])


def _evaluator(motion: Motion, span: float) -> Function:
    times = [case["t"] for case in draws([Variable("t", 0.0, span)], 8, "times")]
    offered, function = motion.parameters(), motion.evaluator

    def compiled() -> Callable[[float], Array]:
        call = compiled_caller(function, "body", offered, type(motion).__name__)
        return lambda t: _written(call, t)

    return Function(
        motion,
        "evaluator",
        function,
        "body",
        offered,
        lambda t: _written(_plain(motion), t),
        compiled,
        [(f"t = {t:.3g}", t) for t in times],
    )


def _plain(motion: Motion) -> Callable[..., Any]:
    return plain_caller(motion.evaluator, "body", motion.parameters())


def _written(call: Callable[..., Any], t: float, old: Array | None = None) -> Array:
    out = np.full(FRAME + ROOM, OLD) if old is None else old.copy()
    if old is None:
        out[:FRAME] = 0.0
    call(t, _NOTHING, _NOTHING, out)
    return out


def _look(motion: Motion, t: float) -> Array:
    return _written(_plain(motion), t)[:FRAME]


def _unit(motion: Motion) -> float:
    """Return the time scale, a second where there is none to go by [s]."""
    scale = float(motion.time_scale)
    return scale if math.isfinite(scale) and scale > 0.0 else 1.0


def _step(motion: Motion) -> float:
    return _STEP * _unit(motion)


def _check_positive(motion: Motion) -> None:
    if not motion.time_scale > 0.0:
        raise Broken("it must be positive [s], or infinite", "time_scale", motion.time_scale)


def _writes(motion: Motion, case: Case) -> str:
    call = _plain(motion)
    clean, before = _written(call, case["t"]), _written(call, abs(case["t"] - 0.637 * _unit(motion)))
    wrong = np.flatnonzero(_written(call, case["t"], before) != clean)
    return f"number {wrong[0]} of the block is left from the call before" if len(wrong) else ""


def _rotation(motion: Motion, case: Case) -> str:
    axes = _look(motion, case["t"])[3:12].reshape(3, 3)
    if not np.allclose(axes.T @ axes, np.eye(3), rtol=0.0, atol=1e-9) or np.linalg.det(axes) < 0.0:
        return f"the axes are {axes.tolist()}"
    return ""


def _compare(name: str, given: Array, found: Array, known: float) -> str:
    size = float(np.max(np.abs(found)))
    # at a knot of a table the differences know little, and nothing is asked
    if np.max(np.abs(given - found)) <= _SAME * size + 10.0 * known:
        return ""
    return f"the {name} is {given.tolist()}, the differences give {found.tolist()}"


def _velocity(motion: Motion, case: Case) -> str:
    t, dt = case["t"], _step(motion)
    here = _look(motion, t)
    found, known = moving.slope(lambda s: _look(motion, t + s)[:3], dt)
    wrong = _compare("velocity", here[12:15], found, known)
    rates, known = moving.slope(lambda s: _look(motion, t + s)[3:12], dt)
    spin = rates.reshape(3, 3) @ here[3:12].reshape(3, 3).T
    turning = 0.5 * np.array([spin[2, 1] - spin[1, 2], spin[0, 2] - spin[2, 0], spin[1, 0] - spin[0, 1]])
    return wrong or _compare("angular velocity", here[15:18], turning, known)


def _acceleration(motion: Motion, case: Case) -> str:
    t = case["t"]
    here = _look(motion, t)
    for name, at in (("acceleration", 12), ("angular acceleration", 15)):
        found, known = moving.slope(lambda s, at=at: _look(motion, t + s)[at : at + 3], _step(motion))  # type: ignore[misc]
        wrong = _compare(name, here[at + 6 : at + 9], found, known)
        if wrong:
            return wrong
    return ""


def _check_jumps(motion: Motion, span: float) -> None:
    for name, part in (("position", slice(0, 3)), *_PARTS):
        found = jump(lambda t, part=part: _look(motion, t)[part], 0.0, span, 256)  # type: ignore[misc]
        if found is not None:
            raise Broken(f"the {name} jumps by {found[1].tolist()}", case={"t": found[0]})


def _check_scale(motion: Motion, span: float) -> None:
    scale = float(motion.time_scale)
    if not scale > 0.0:
        raise NotChecked("not checked, as the time scale is not positive")
    piece = min(scale, span) / _PIECES
    blocks = np.array([_look(motion, t) for t in np.arange(0.0, span + piece, 0.5 * piece)])
    for name, part in _PARTS:
        values = blocks[:, part]
        size = float(np.max(np.abs(values)))
        if not math.isfinite(scale):
            if np.max(np.abs(values - values[0])) > 1e-9 * size:
                raise Broken(f"the {name} changes", "time_scale", scale)
            continue
        bent = np.max(np.abs(values[1:-1] - 0.5 * (values[:-2] + values[2:])), axis=1)
        if np.max(bent) > _BENT * size:
            when = 0.5 * piece * (1 + int(np.argmax(bent)))
            words = (
                f"within {piece:g} s the {name} departs by {np.max(bent) / size:.0%} of its size from a straight line"
            )
            raise Broken(words, "time_scale", scale, {"t": when})
