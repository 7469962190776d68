"""Properties of joints."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from nonsmooth.engine.memory.blocks import JOINT_ROW
from nonsmooth.interfaces import Joint
from nonsmooth.rotations import rotation, turned
from nonsmooth.testing import moving
from nonsmooth.testing.callers import compiled_caller, plain_caller
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.draws import Case, draws
from nonsmooth.testing.examine import Trial, examine
from nonsmooth.testing.functions import OLD, ROOM, Function, Functions
from nonsmooth.testing.look import check_ends
from nonsmooth.testing.moving import Array, Frames
from nonsmooth.testing.property import Broken, Property, Row, properties

_DRAWS = 24
_SAME = 1e-7
_PARTS = (
    ("residual", slice(0, 1)),
    ("axis", slice(1, 4)),
    ("moment", slice(4, 7)),
    ("first point", slice(7, 10)),
    ("second point", slice(10, 13)),
    ("bias", slice(13, 14)),
)
"""What a row is made of."""
_MOST_ROWS = 6
_TRIES, _STEPS = 12, 40
_CLOSED = 1e-12
_INDEPENDENT = 1e-9


def check_joint(joint: Joint) -> list[Property]:
    """Return the properties of a joint.

    Parameters
    ----------
    joint : Joint
        The joint; it is looked at between two frames about a metre apart.
    """
    functions = Functions(lambda: [_evaluator(joint)])

    def row(name: str, says: str, trial: Trial) -> Row:
        return name, says, lambda: examine(name, [joint], moving.space(), trial, _DRAWS)

    rows = [
        row("writes its block", "it writes every number that can be non-zero, and nothing beyond its rows", _writes),
        row("rate", "axis and moment give the derivative of the residual, by differences", _rate),
        row("bias", "it is the derivative of the rate while u' = 0, by differences", _bias),
        row("frame invariance", "where both bodies are moved together, residuals stay and axes turn with them", _moved),
        ("can be closed", "there are poses at which all residuals vanish", lambda: _check_closed(joint)),
        ("ends", "it can be drawn where it holds", lambda: check_ends(joint.ends)),
        ("independent rows", "where it is closed, no row follows from the others", lambda: _check_rank(joint)),
    ]
    sizes: list[Row] = [("number of rows", "it takes one to six degrees of freedom", lambda: _check_number(joint))]
    return properties(joint, [*component_rows(joint), *sizes, *functions.rows(), *functions.guarded(rows)])


def _evaluator(joint: Joint) -> Function:
    inputs = [("a, b", moving.frames(case)) for case in draws(moving.space(), 8, "frames")]
    offered, function = joint.parameters(), joint.evaluator

    def compiled() -> Callable[[Frames], Array]:
        call = compiled_caller(function, "pair", offered, type(joint).__name__)
        return lambda at: _written(joint, call, at)

    return Function(
        joint, "evaluator", function, "pair", offered, lambda at: _written(joint, _plain(joint), at), compiled, inputs
    )


def _plain(joint: Joint) -> Callable[..., Any]:
    return plain_caller(joint.evaluator, "pair", joint.parameters())


def _written(joint: Joint, call: Callable[..., Any], at: Frames, old: Array | None = None) -> Array:
    out = np.full(JOINT_ROW * joint.n_rows + ROOM, OLD) if old is None else old.copy()
    if old is None:
        out[:-ROOM] = 0.0
    call(*at, out)
    return out


def _look(joint: Joint, at: Frames) -> Array:
    """Return the rows, shape [n_rows, 14]."""
    return _written(joint, _plain(joint), at)[:-ROOM].reshape(joint.n_rows, JOINT_ROW)


def _sides(row: Array, at: Frames) -> Array:
    """Return what a row makes of velocity and angular velocity of both frames, shape [12]."""
    a, b = at
    axis, moment = row[1:4], row[4:7]
    first, second = np.cross(row[7:10] - a[:3], axis) + moment, np.cross(row[10:13] - b[:3], axis) + moment
    return np.concatenate([-axis, -first, axis, second])


def _rates(joint: Joint, at: Frames) -> Array:
    velocities = np.concatenate([at[0][12:18], at[1][12:18]])
    return np.array([_sides(row, at) @ velocities for row in _look(joint, at)])


def _check_number(joint: Joint) -> None:
    if joint.n_rows not in range(1, _MOST_ROWS + 1):
        raise Broken(f"it must be a whole number from 1 to {_MOST_ROWS}", "n_rows", joint.n_rows)


def _writes(joint: Joint, case: Case) -> str:
    call, other = _plain(joint), {name: -0.9 * value + 0.11 for name, value in case.items()}
    clean = _written(joint, call, moving.frames(case))
    again = _written(joint, call, moving.frames(case), _written(joint, call, moving.frames(other)))
    wrong = np.flatnonzero(again != clean)
    if len(wrong) == 0:
        return ""
    return f"number {wrong[0] % JOINT_ROW} of row {wrong[0] // JOINT_ROW} is left from the call before"


def _compare(name: str, given: Array, found: Array, known: float) -> str:
    worst = int(np.argmax(np.abs(given - found)))
    if abs(given[worst] - found[worst]) <= _SAME * (1.0 + float(np.max(np.abs(found)))) + 10.0 * known:
        return ""
    return f"the {name} of row {worst} is {given[worst]:.9g}, the differences give {found[worst]:.9g}"


def _rate(joint: Joint, case: Case) -> str:
    found, known = moving.slope(lambda dt: _look(joint, moving.frames(case, dt))[:, 0])
    return _compare("rate", _rates(joint, moving.frames(case)), found, known)


def _bias(joint: Joint, case: Case) -> str:
    # the frames' accelerations are those that their bodies have while u' = 0
    found, known = moving.slope(lambda dt: _rates(joint, moving.frames(case, dt)))
    return _compare("bias", _look(joint, moving.frames(case))[:, 13], found, known)


def _moved(joint: Joint, case: Case) -> str:
    a, b = moving.frames(case)
    here = _look(joint, (a, b))
    there = _look(joint, (moving.moved(a, moving.TURN, moving.SHIFT), moving.moved(b, moving.TURN, moving.SHIFT)))
    turned_rows = here.copy()
    for part in (1, 4, 7, 10):
        turned_rows[:, part : part + 3] = here[:, part : part + 3] @ moving.TURN.T
    acts = np.any(here[:, 1:4] != 0.0, axis=1)
    # the points of a row without an axis mean nothing
    turned_rows[acts, 7:10] += moving.SHIFT
    turned_rows[acts, 10:13] += moving.SHIFT
    turned_rows[~acts, 7:13] = there[~acts, 7:13] = 0.0
    for name, part in (
        ("residual", 0),
        ("axis", 1),
        ("moment", 4),
        ("first point", 7),
        ("second point", 10),
        ("bias", 13),
    ):
        width = 1 if part in (0, 13) else 3
        one, other = there[:, part : part + width], turned_rows[:, part : part + width]
        row = int(np.argmax(np.max(np.abs(one - other), axis=1)))
        if np.max(np.abs(one[row] - other[row])) > 1e-9 * (1.0 + float(np.max(np.abs(other[row])))):
            return f"the {name} of row {row} becomes {one[row]}, moved with the bodies it would be {other[row]}"
    return ""


def _closed(joint: Joint) -> list[Frames]:
    """Return poses at which the joint is closed, found by Newton's method on the second body from drawn ones."""
    found = []
    for case in draws(moving.space(), _TRIES, "closed"):
        still = {name: 0.0 if name.split("_")[0] not in ("place", "turn") else value for name, value in case.items()}
        a, b = moving.frames(still)
        for _ in range(_STEPS):
            rows = _look(joint, (a, b))
            if np.max(np.abs(rows[:, 0])) < _CLOSED:
                found.append((a, b))
                break
            lines = np.array([_sides(row, (a, b))[6:] for row in rows])
            way = -np.linalg.lstsq(lines, rows[:, 0], rcond=1e-9)[0]
            way *= min(1.0, 0.5 / max(float(np.linalg.norm(way)), 1e-300))
            b = b.copy()
            b[:3] += way[:3]
            b[3:12] = (rotation(turned((1.0, 0.0, 0.0, 0.0), way[3:])) @ b[3:12].reshape(3, 3)).ravel()
    return found


def _check_closed(joint: Joint) -> None:
    if not _closed(joint):
        raise Broken(f"Newton's method finds none from {_TRIES} places")


def _check_rank(joint: Joint) -> None:
    closed = _closed(joint)
    ranks = []
    for at in closed:
        lines = np.array([_sides(row, at) for row in _look(joint, at)])
        sizes = np.linalg.norm(lines, axis=1)
        if np.min(sizes) == 0.0:
            raise Broken("it has neither axis nor moment", "row", int(np.argmin(sizes)))
        ranks.append(int(np.sum(np.linalg.svd(lines / sizes[:, None], compute_uv=False) > _INDEPENDENT)))
    # a pose of its own may be singular
    if ranks and max(ranks) < joint.n_rows:
        raise Broken(f"only {max(ranks)} of its rows are independent", "n_rows", joint.n_rows)
