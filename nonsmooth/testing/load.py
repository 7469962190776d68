"""Conformance checks of loads: continuity, dependence on time, and independence of a common motion of the bodies.

Each claim states a property in its docstring. It returns or raises a message if the property fails, else "" or None.
"""

from __future__ import annotations

import numpy as np

from nonsmooth.engine.memory.blocks import FORCE, LOAD, LOAD_MOMENT, LOAD_POINT
from nonsmooth.interfaces import Load
from nonsmooth.rotations import cross
from nonsmooth.testing.claims import Claims, rows
from nonsmooth.testing.differences import jump
from nonsmooth.testing.functions import CheckedFunction, all_rows, left_over, plain_caller, written
from nonsmooth.testing.inputs import draws, number
from nonsmooth.testing.movement import MOVEMENT, SHIFT, TURN, Frames, Movement, moved, shared
from nonsmooth.testing.outcome import Row
from nonsmooth.testing.property import Property, properties
from nonsmooth.testing.shape import require_ends
from nonsmooth.types import Array

_DRAWS = 24
_SAME = 1e-9
_TIME = number("t", 0.0, 1.0)
_LATER = 0.37
"""Time between two evaluations of a load at the same state [s]. A load that differs between them depends on time. The
time is not a round number, because a periodic load has the same force after a multiple of its period."""
_WHILE = 0.2
"""Force and moment are searched for jumps from this time before each input to this time after it, while the two frames
move [s]."""
_PARTS = {
    "force": slice(FORCE, LOAD_POINT),
    "point": slice(LOAD_POINT, LOAD_MOMENT),
    "moment": slice(LOAD_MOMENT, LOAD),
}
_LOAD, _FREE = Claims(), Claims()
"""Claims about every load, and claims about loads that depend only on the relative motion of their two bodies."""


def check_load(load: Load, *, tied_to_space: bool = False) -> list[Property]:
    """Return the properties that every load must have, each with its check of this load.

    Parameters
    ----------
    load : Load
        The load; it is checked between two frames about a metre apart.
    tied_to_space : bool, optional
        True if the load depends on directions, places or speeds in space, as weight, wind and drag do. Then the load is
        not checked with bodies that move together. If this holds for all objects of a class, the class can name the
        failing property in its attribute ``departures`` instead.
    """
    return properties(load, _rows, tied_to_space=tied_to_space)


def _rows(load: Load, tied_to_space: bool) -> list[Row]:
    claims = _LOAD if tied_to_space else [*_LOAD, *_FREE]
    return all_rows(load, lambda: [_evaluator(load)], rows(claims, lambda: [load], _DRAWS))


def _evaluator(load: Load) -> CheckedFunction:
    inputs = [(f"t = {c['t']:.3g}, a, b", (c["t"], *Movement(c).at())) for c in draws([_TIME, MOVEMENT], 8)]
    return CheckedFunction(load, "evaluator", "load", load.parameters(), inputs, LOAD)


def _look(load: Load, t: float, at: Frames) -> Array:
    call = plain_caller(load.evaluator, "load", load.parameters())
    return written(lambda out: call(t, *at, out), LOAD)[:LOAD]


@_LOAD.claim(_TIME, MOVEMENT)
def _writes_its_block(load: Load, t: float, move: Movement) -> str:
    """A call of the load writes every number of its block that is not always zero, and nothing outside of it."""
    call, here, there = plain_caller(load.evaluator, "load", load.parameters()), move.at(), move.mirrored.at()
    return left_over(lambda out: call(t, *here, out), lambda out: call(1.0 - t, *there, out), LOAD)


@_LOAD.claim(_TIME, MOVEMENT)
def _no_jumps(load: Load, t: float, move: Movement) -> str:
    """Force and moment are continuous while the bodies move."""
    found = jump(lambda dt: _about_origin(_look(load, t + dt, move.at(dt))), -_WHILE, _WHILE)
    return "" if found is None else f"{found[0]:.6g} s after the input force and moment jump by {found[1].tolist()}"


def _about_origin(block: Array) -> Array:
    """Return the force [N] and the total moment about the origin [N m], shape [6].

    They do not depend on the place of the point along the line of the force.
    """
    force, point, moment = (block[part] for part in _PARTS.values())
    return np.concatenate([force, moment + cross(point, force)])


@_LOAD.claim(_TIME, MOVEMENT, name="time")
def _depends_on_time(load: Load, t: float, move: Movement) -> str:
    """A load whose `depends_on_time` is False has the same force and moment at another time."""
    later = t + _LATER
    if load.depends_on_time or np.array_equal(_look(load, t, move.at()), _look(load, later, move.at())):
        return ""
    return f"it differs at t = {later:.3g}: `depends_on_time` must be True"


@_LOAD.claim()
def _ends(load: Load) -> None:
    """The two points that show the load in pictures (`ends`) are finite."""
    require_ends(load.ends)


def _unlike(given: Array, wanted: Array, words: str) -> str:
    for name, part in _PARTS.items():
        size = 1.0 + float(np.max(np.abs(wanted[part])))
        if np.max(np.abs(given[part] - wanted[part])) > _SAME * size:
            return f"the {name} becomes {given[part]}, {words} it would be {wanted[part]}"
    return ""


@_FREE.claim(_TIME, MOVEMENT)
def _frame_invariance(load: Load, t: float, move: Movement) -> str:
    """If both bodies are moved together, force and moment turn with the bodies."""
    wanted = (_look(load, t, move.at()).reshape(3, 3) @ TURN.T).ravel()
    wanted[_PARTS["point"]] += SHIFT
    return _unlike(_look(load, t, moved(move.at())), wanted, "moved with the bodies")


@_FREE.claim(_TIME, MOVEMENT)
def _relative_motion(load: Load, t: float, move: Movement) -> str:
    """Force and moment do not change if the same rigid motion is added to the motion of both bodies."""
    there = shared(move.at(), np.array([0.7, -1.1, 0.4]), np.array([-0.5, 0.9, 1.3]))
    return _unlike(_look(load, t, there), _look(load, t, move.at()), "without the shared motion")
