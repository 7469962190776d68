"""Conformance checks of joints: constraint rows, their derivatives, and poses at which the joint is closed.

Each claim states a property in its docstring. It returns or raises a message if the property fails, else "" or None.
"""

from __future__ import annotations

import functools

import numpy as np

from nonsmooth.engine.memory.blocks import AXIS, JOINT_ROW, MOMENT, POINT_A, POINT_B, RESIDUAL, ROW_BIAS
from nonsmooth.interfaces import Joint
from nonsmooth.rotations import rotation, turned
from nonsmooth.testing.claims import Claims, claim, rows
from nonsmooth.testing.differences import slope
from nonsmooth.testing.functions import CheckedFunction, all_rows, left_over, plain_caller, written
from nonsmooth.testing.inputs import draws
from nonsmooth.testing.movement import MOVEMENT, SHIFT, STEP, TURN, Frames, Movement, moved
from nonsmooth.testing.outcome import Broken, Row
from nonsmooth.testing.property import Property, properties
from nonsmooth.testing.shape import require_ends
from nonsmooth.types import Array

_DRAWS = 24
_SAME, _ROUND_OFF = 1e-7, 1e-9
_PARTS = {
    "residual": slice(RESIDUAL, AXIS),
    "axis": slice(AXIS, MOMENT),
    "moment": slice(MOMENT, POINT_A),
    "first point": slice(POINT_A, POINT_B),
    "second point": slice(POINT_B, ROW_BIAS),
    "bias": slice(ROW_BIAS, JOINT_ROW),
}
"""Slice of each quantity in the array of numbers that a joint writes for a constraint row, by the quantity's name."""
_MOST_ROWS = 6
_TRIES, _STEPS = 12, 40
_CLOSED = 1e-12
_INDEPENDENT = 1e-9
_JOINT = Claims()


def check_joint(joint: Joint) -> list[Property]:
    """Return the properties of a joint.

    Parameters
    ----------
    joint : Joint
        The joint; it is checked between two frames about a metre apart.
    """
    return properties(joint, _rows)


def _rows(joint: Joint) -> list[Row]:
    table = functools.partial(rows, components=lambda: [joint], count=_DRAWS)
    return all_rows(joint, lambda: [_evaluator(joint)], table(_JOINT), table([_number_of_rows]))


def _evaluator(joint: Joint) -> CheckedFunction:
    inputs = [("a, b", Movement(case).at()) for case in draws([MOVEMENT], 8)]
    return CheckedFunction(joint, "evaluator", "pair", joint.parameters(), inputs, JOINT_ROW * joint.n_rows)


def _look(joint: Joint, at: Frames) -> Array:
    """Return the constraint rows that a joint writes for two frames, shape [n_rows, 14]."""
    size, call = JOINT_ROW * joint.n_rows, plain_caller(joint.evaluator, "pair", joint.parameters())
    return written(lambda out: call(*at, out), size)[:size].reshape(joint.n_rows, JOINT_ROW)


def _sides(row: Array, at: Frames) -> Array:
    """Return the coefficients of velocity and angular velocity of both frames in the rate of a constraint row, [12]."""
    a, b = at
    axis, moment = row[_PARTS["axis"]], row[_PARTS["moment"]]
    first = np.cross(row[_PARTS["first point"]] - a[:3], axis) + moment
    second = np.cross(row[_PARTS["second point"]] - b[:3], axis) + moment
    return np.concatenate([-axis, -first, axis, second])


def _rates(joint: Joint, at: Frames) -> Array:
    velocities = np.concatenate([at[0][12:18], at[1][12:18]])
    return np.array([_sides(row, at) @ velocities for row in _look(joint, at)])


@claim()
def _number_of_rows(joint: Joint) -> None:
    """The joint constrains one to six degrees of freedom."""
    if joint.n_rows not in range(1, _MOST_ROWS + 1):
        raise Broken(f"it must be a whole number from 1 to {_MOST_ROWS}", "n_rows", joint.n_rows)


@_JOINT.claim(MOVEMENT)
def _writes_its_block(joint: Joint, move: Movement) -> str:
    """The joint writes every number of its constraint rows that can be non-zero, and nothing beyond the rows."""
    call, here, there = plain_caller(joint.evaluator, "pair", joint.parameters()), move.at(), move.mirrored.at()
    size = JOINT_ROW * joint.n_rows
    return left_over(lambda out: call(*here, out), lambda out: call(*there, out), size, JOINT_ROW)


def _unlike(name: str, given: Array, found: Array, known: float) -> str:
    """Return a message on the constraint row with the largest mismatch of a quantity; "" if all rows agree.

    ``given`` are the values by the joint, one for each row. ``found`` are the values by difference quotients, and
    ``known`` is the bound of their error. ``name`` is the name of the quantity, for the message.
    """
    worst = int(np.argmax(np.abs(given - found)))
    if abs(given[worst] - found[worst]) <= _SAME * (1.0 + float(np.max(np.abs(found)))) + 10.0 * known:
        return ""
    return f"the {name} of row {worst} is {given[worst]:.9g}, the differences give {found[worst]:.9g}"


@_JOINT.claim(MOVEMENT)
def _rate(joint: Joint, move: Movement) -> str:
    """Axis and moment of each constraint row give the time derivative of its residual."""
    return _unlike("rate", _rates(joint, move.at()), *slope(lambda dt: _look(joint, move.at(dt))[:, RESIDUAL], STEP))


@_JOINT.claim(MOVEMENT)
def _bias(joint: Joint, move: Movement) -> str:
    """The bias of each constraint row is the time derivative of its rate while u' = 0."""
    # the frames' accelerations are those that their bodies have while u' = 0
    bias = _look(joint, move.at())[:, ROW_BIAS]
    return _unlike("bias", bias, *slope(lambda dt: _rates(joint, move.at(dt)), STEP))


@_JOINT.claim(MOVEMENT)
def _frame_invariance(joint: Joint, move: Movement) -> str:
    """If both bodies are moved together, the joint's residuals are the same and its axes turn with the bodies."""
    here, there = _look(joint, move.at()), _look(joint, moved(move.at()))
    # the points of a row without an axis have no effect
    acts = np.any(here[:, _PARTS["axis"]] != 0.0, axis=1)
    for name, part in _PARTS.items():
        one, other = there[:, part], here[:, part]
        if part.stop - part.start == 3:
            other = other @ TURN.T
        if name.endswith("point"):
            one, other = one * acts[:, None], (other + SHIFT) * acts[:, None]
        row = int(np.argmax(np.max(np.abs(one - other), axis=1)))
        if np.max(np.abs(one[row] - other[row])) > _ROUND_OFF * (1.0 + float(np.max(np.abs(other[row])))):
            return f"the {name} of row {row} becomes {one[row]}, moved with the bodies it would be {other[row]}"
    return ""


def _closed(joint: Joint) -> list[Frames]:
    """Return poses of two bodies at which a joint is closed, as frame blocks.

    Newton's method starts from random poses and moves the second body until all residuals of the joint vanish.
    """
    found = []
    for case in draws([MOVEMENT], _TRIES):
        a, b = Movement(case).still.at()
        for _ in range(_STEPS):
            lines = _look(joint, (a, b))
            residuals = lines[:, RESIDUAL]
            if np.max(np.abs(residuals)) < _CLOSED:
                found.append((a, b))
                break
            sides = np.array([_sides(row, (a, b))[6:] for row in lines])
            step = -np.linalg.lstsq(sides, residuals, rcond=1e-9)[0]
            step *= min(1.0, 0.5 / max(float(np.linalg.norm(step)), 1e-300))
            b = b.copy()
            b[:3] += step[:3]
            b[3:12] = (rotation(turned((1.0, 0.0, 0.0, 0.0), step[3:])) @ b[3:12].reshape(3, 3)).ravel()
    return found


@_JOINT.claim()
def _can_be_closed(joint: Joint) -> str:
    """There are poses of the bodies at which all residuals of the joint vanish."""
    return "" if _closed(joint) else f"Newton's method finds none from {_TRIES} places"


@_JOINT.claim()
def _ends(joint: Joint) -> None:
    """The two points that show the joint in pictures (`ends`) are finite."""
    require_ends(joint.ends)


@_JOINT.claim()
def _independent_rows(joint: Joint) -> None:
    """At poses at which the joint is closed, its constraint rows are linearly independent."""
    ranks = []
    for at in _closed(joint):
        lines = np.array([_sides(row, at) for row in _look(joint, at)])
        sizes = np.linalg.norm(lines, axis=1)
        if np.min(sizes) == 0.0:
            raise Broken("it has neither axis nor moment", "row", int(np.argmin(sizes)))
        ranks.append(int(np.sum(np.linalg.svd(lines / sizes[:, None], compute_uv=False) > _INDEPENDENT)))
    # rows may be dependent at a single pose, which is then singular: the check fails if they are dependent at all poses
    if ranks and max(ranks) < joint.n_rows:
        raise Broken(f"only {max(ranks)} of its rows are independent", "n_rows", joint.n_rows)
