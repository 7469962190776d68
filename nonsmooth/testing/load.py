"""Properties of loads."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from nonsmooth.engine.memory.blocks import LOAD
from nonsmooth.interfaces import Load
from nonsmooth.rotations import cross
from nonsmooth.testing import moving
from nonsmooth.testing.callers import compiled_caller, plain_caller
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.draws import Case, Variable, draws
from nonsmooth.testing.examine import Trial, examine
from nonsmooth.testing.functions import OLD, ROOM, Function, Functions
from nonsmooth.testing.jumps import jump
from nonsmooth.testing.look import check_ends
from nonsmooth.testing.moving import Array, Frames
from nonsmooth.testing.property import Property, Row, properties

_DRAWS = 24
_SAME = 1e-9
_WHILE = 0.05
"""How long the frames move on either side of an input, where a load is looked at for jumps [s]."""
_PARTS = (("force", slice(0, 3)), ("point", slice(3, 6)), ("moment", slice(6, 9)))


def check_load(load: Load, *, tied_to_space: bool = False) -> list[Property]:
    """Return the properties of a load.

    Parameters
    ----------
    load : Load
        The load; it is looked at between two frames about a metre apart.
    tied_to_space : bool, optional
        Whether it knows directions, places or speeds in space, as a weight, a wind or a drag do: then nothing is asked
        of bodies that move together.  A class of which that is always true says it in its ``departures``.
    """
    functions = Functions(lambda: [_evaluator(load)])

    def row(name: str, says: str, trial: Trial) -> Row:
        return name, says, lambda: examine(name, [load], _space(), trial, _DRAWS)

    rows = [
        row("writes its block", "it writes every number that can be non-zero, and nothing beyond the block", _writes),
        row("no jumps", "force and moment are continuous where the bodies move", _jumps),
    ]
    rows.append(row("time", "a load that says so does not depend on time", _constant))
    rows.append(("ends", "it can be drawn where it acts", lambda: check_ends(load.ends)))
    if not tied_to_space:
        rows += [
            row("frame invariance", "where both bodies are moved together, force and moment turn with them", _moved),
            row("relative motion", "it does not feel a motion that both bodies share", _shared),
        ]
    return properties(load, [*component_rows(load), *functions.rows(), *functions.guarded(rows)])


def _constant(load: Load, case: Case) -> str:
    at, later = moving.frames(case), case["t"] + 0.37
    if load.depends_on_time or np.array_equal(_look(load, case["t"], at), _look(load, later, at)):
        return ""
    return f"it differs at t = {later:.3g}: `depends_on_time` must be True"


def _space() -> list[Variable]:
    return [Variable("t", 0.0, 1.0), *moving.space()]


def _evaluator(load: Load) -> Function:
    inputs = [(f"t = {case['t']:.3g}, a, b", (case["t"], moving.frames(case))) for case in draws(_space(), 8, "frames")]
    offered, function = load.parameters(), load.evaluator

    def compiled() -> Callable[[Any], Array]:
        call = compiled_caller(function, "load", offered, type(load).__name__)
        return lambda at: _written(call, *at)

    return Function(
        load, "evaluator", function, "load", offered, lambda at: _written(_plain(load), *at), compiled, inputs
    )


def _plain(load: Load) -> Callable[..., Any]:
    return plain_caller(load.evaluator, "load", load.parameters())


def _written(call: Callable[..., Any], t: float, at: Frames, old: Array | None = None) -> Array:
    out = np.full(LOAD + ROOM, OLD) if old is None else old.copy()
    if old is None:
        out[:LOAD] = 0.0
    call(t, *at, out)
    return out


def _look(load: Load, t: float, at: Frames) -> Array:
    return _written(_plain(load), t, at)[:LOAD]


def _writes(load: Load, case: Case) -> str:
    call, at = _plain(load), (case["t"], moving.frames(case))
    other = {name: -0.9 * value + 0.11 for name, value in case.items()}
    before = _written(call, 1.0 - case["t"], moving.frames(other))
    wrong = np.flatnonzero(_written(call, *at, before) != _written(call, *at))
    return f"number {wrong[0]} of the block is left from the call before" if len(wrong) else ""


def _jumps(load: Load, case: Case) -> str:
    def value(dt: float) -> Array:
        return _about_origin(_look(load, case["t"] + dt, moving.frames(case, dt)))

    found = jump(value, -_WHILE, _WHILE)
    if found is None:
        return ""
    where, change = found
    return f"{where:.6g} s after the input force and moment jump by {change.tolist()}"


def _about_origin(block: Array) -> Array:
    """Return force and its moment about the origin with the moment: where it acts along its line does not matter."""
    return np.concatenate([block[:3], block[6:9] + cross(block[3:6], block[:3])])


def _compare(given: Array, wanted: Array, words: str) -> str:
    for name, part in _PARTS:
        size = 1.0 + float(np.max(np.abs(wanted[part])))
        if np.max(np.abs(given[part] - wanted[part])) > _SAME * size:
            return f"the {name} becomes {given[part]}, {words} it would be {wanted[part]}"
    return ""


def _moved(load: Load, case: Case) -> str:
    a, b = moving.frames(case)
    here = _look(load, case["t"], (a, b))
    there = (moving.moved(a, moving.TURN, moving.SHIFT), moving.moved(b, moving.TURN, moving.SHIFT))
    wanted = np.concatenate([moving.TURN @ here[part] for _, part in _PARTS])
    wanted[3:6] += moving.SHIFT
    return _compare(_look(load, case["t"], there), wanted, "moved with the bodies")


def _shared(load: Load, case: Case) -> str:
    a, b = moving.frames(case)
    velocity, spin = np.array([0.7, -1.1, 0.4]), np.array([-0.5, 0.9, 1.3])
    there = moving.shared(a, velocity, spin), moving.shared(b, velocity, spin)
    here = _look(load, case["t"], (a, b))
    return _compare(_look(load, case["t"], there), here, "without the shared motion")
