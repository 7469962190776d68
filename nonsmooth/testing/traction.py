"""Properties of laws of traction."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from nonsmooth.interfaces import TractionLaw
from nonsmooth.testing.callers import compiled_caller, plain_caller
from nonsmooth.testing.component import component_rows, variants
from nonsmooth.testing.draws import Case, Variable, draws
from nonsmooth.testing.examine import FEWEST, Trial, examine
from nonsmooth.testing.functions import Function, Functions
from nonsmooth.testing.jumps import jump
from nonsmooth.testing.property import Property, Row, properties
from nonsmooth.testing.puck import Array, Cushion, Puck, run
from nonsmooth.testing.states import check_start, fastest, followed, misplaced, require_start, written

_DRAWS = 8
_WRENCH = 5
"""Numbers of force and moment."""
_LOAD = Variable("normal_force", 1e-2, 1e2, 1.0, log=True)
_MOTION = (
    Variable("slip_speed", 1e-3, 1.0, 1.0, log=True),
    Variable("heading", -3.1, 3.1),
    Variable("rolling", 0.0, 3.0),
    Variable("rolling_heading", -3.1, 3.1),
    Variable("drilling", -3.0, 3.0),
)
_BENT = Variable("bent", -2.0, 2.0)
_LONG, _SHORT = 40.0, 0.5
"""How long a steady motion lasts, and how long to look before it is steady, in the time that fills the states."""
_SAMPLES = 20
_TIMES, _TURNS = 5.0, 60.0
"""How long a mass is followed: in the time that fills the states, and in the fastest time of the motion at most."""
_SAME, _STEPS = 1e-5, 1e-7
"""Deviations: of the change, and of the whole, by the engine's tolerance of 1e-9 per step."""


def check_traction_law(law: TractionLaw) -> list[Property]:
    """Return the properties of a law of traction.

    Parameters
    ----------
    law : TractionLaw
        The law, with parameters.
    """
    functions = Functions(lambda: [_traction(one) for one in variants(law)])

    def row(name: str, says: str, trial: Trial, *space: Variable, fewest: int | None = None) -> Row:
        return name, says, lambda: examine(name, variants(law), space, trial, _DRAWS, fewest=fewest)

    first = row("initial state", "initial states and scales are as many, finite, the scales positive", _starts)
    rows = [
        row(
            "writes its block",
            "it writes force, moment and the rate of every state, and nothing else",
            _writes,
            _LOAD,
            *_MOTION,
        ),
        row(
            "no jumps",
            "force, moment and rates are continuous in load, motion and states",
            _jumps,
            _LOAD,
            *_MOTION,
            _BENT,
        ),
        row("nothing without load", "without normal force there is no traction", _unloaded, *_MOTION, _BENT),
        row("dissipation", "in a steady motion it takes energy out, or none", _dissipates, _LOAD, *_MOTION),
        row(
            "frame invariance",
            "force and moment turn with the motion, from the closing of the contact on",
            _turned,
            _LOAD,
            *_MOTION,
            Variable("turn", -3.1, 3.1, 1.0),
        ),
        row(
            "certificate",
            "it accepts force and moment of the law, and none that differ by a hundredth",
            _certificate,
            _LOAD,
            *_MOTION,
            _BENT,
        ),
        row(
            "sustained motion",
            "a body that slides, rolls and drills in the engine goes as an independent integration has it",
            _moves,
            _LOAD,
            *_MOTION,
            fewest=FEWEST,
        ),
    ]
    return properties(law, [*component_rows(law), first, *functions.rows(), *functions.guarded(rows)])


def _motion(case: Case, turn: float = 0.0) -> Array:
    """Return slip, rolling and drilling."""
    found = []
    for size, heading in ((case["slip_speed"], case["heading"]), (case["rolling"], case["rolling_heading"])):
        found += [size * math.cos(heading + turn), size * math.sin(heading + turn)]
    return np.array([*found, case["drilling"]])


def _scale(law: TractionLaw) -> Array:
    return np.array(law.state_scale, dtype=float)


def _start(law: TractionLaw) -> Array:
    return np.array(law.initial_state, dtype=float)


def _traction(law: TractionLaw) -> Function:
    require_start(law.initial_state, law.state_scale)
    n, offered = _WRENCH + len(law.initial_state), law.parameters()
    motions = [np.zeros(_WRENCH), *(_motion(case) for case in draws(_MOTION, 4, "motions"))]
    states = [_start(law) + share * _scale(law) for share in (0.0, 0.7, -3.0)]
    inputs = [
        (f"{load:g}, {motion.tolist()}, {state.tolist()}", (load, motion, state))
        for load in (0.0, 1.0, -1.0, 100.0)
        for motion in motions
        for state in states
    ]

    def called(call: Callable[..., Any]) -> Callable[[Any], Array]:
        return lambda at: written(lambda out: call(at[0], at[1].copy(), at[2].copy(), out), n)

    return Function(
        law,
        "traction",
        law.traction,
        "traction",
        offered,
        called(plain_caller(law.traction, "traction", offered)),
        lambda: called(compiled_caller(law.traction, "traction", offered, type(law).__name__)),
        inputs,
    )


def _look(law: TractionLaw, load: float, motion: Array, state: Array) -> tuple[Array, Array]:
    """Return force with moment, and rates of the states."""
    n, call = len(state), plain_caller(law.traction, "traction", law.parameters())
    out = written(lambda out: call(load, motion, state, out), _WRENCH + n)
    return out[:_WRENCH], out[_WRENCH : _WRENCH + n]


def _bent(law: TractionLaw, case: Case) -> Array:
    # not all states alike
    shares = case["bent"] * np.cos(1.0 + np.arange(len(law.initial_state)))
    return np.asarray(_start(law) + shares * _scale(law))


def _starts(law: TractionLaw, case: Case) -> str:
    return check_start(law.initial_state, law.state_scale)


def _writes(law: TractionLaw, case: Case) -> str:
    call, state, load = plain_caller(law.traction, "traction", law.parameters()), _start(law), case["normal_force"]
    for motion in (_motion(case), np.zeros(_WRENCH)):
        if found := misplaced(functools.partial(call, load), [motion, state], _WRENCH + len(state)):
            return found
    return ""


def _jumps(law: TractionLaw, case: Case) -> str:
    motion, state, load = _motion(case), _bent(law, case), case["normal_force"]

    def value(share: float) -> Array:
        wrench, rates = _look(law, load, share * motion, state)
        return np.concatenate([wrench, rates / _scale(law)])

    def loaded(share: float) -> Array:
        return _look(law, share * load, motion, state)[0]

    for words, function in (("motion", value), ("load", loaded)):
        if (found := jump(function, -1.0, 1.0)) is not None:
            return f"at {found[0]:.6g} times this {words} it jumps by {found[1].tolist()}"
    return ""


def _unloaded(law: TractionLaw, case: Case) -> str:
    wrench, _ = _look(law, 0.0, _motion(case), _bent(law, case))
    return f"force and moment are {wrench.tolist()}" if np.any(wrench != 0.0) else ""


def _filling(law: TractionLaw, load: float, motion: Array) -> float:
    """Return the time in which the motion brings the states to their usual sizes [s], zero without states."""
    rates = np.abs(_look(law, load, motion, _start(law))[1])
    return float(np.max(_scale(law)[rates > 0.0] / rates[rates > 0.0], initial=0.0))


def _through(law: TractionLaw, load: float, motion: Array, times: Sequence[float]) -> Array:
    """Return the states through a steady motion, from the closing of the contact on, shape [n_times, n]."""
    return followed(lambda z: _look(law, load, motion, z)[1], _start(law), _scale(law), times, stiff=True)


def _dissipates(law: TractionLaw, case: Case) -> str:
    load, motion = case["normal_force"], _motion(case)
    unit = _filling(law, load, motion)
    times = unit * np.linspace(0.5 * _LONG, _LONG, _SAMPLES)
    states = _through(law, load, motion, times.tolist()) if unit > 0.0 else [_start(law)]
    wrenches = [_look(law, load, motion, state)[0] for state in states]
    mean = float(np.mean([wrench @ motion for wrench in wrenches]))
    gross = max(float(np.abs(wrench) @ np.abs(motion)) for wrench in wrenches)
    return f"in the long run it gives {mean:g} W" if mean > 1e-9 * gross else ""


def _turned(law: TractionLaw, case: Case) -> str:
    load, turn = case["normal_force"], case["turn"]
    unit = _filling(law, load, _motion(case))
    c, s = math.cos(turn), math.sin(turn)
    both = np.zeros((_WRENCH, _WRENCH))
    both[:2, :2] = both[2:4, 2:4] = [[c, -s], [s, c]]
    both[4, 4] = 1.0
    times = [_SHORT * unit, _TIMES * unit]
    ways = [
        (motion, _through(law, load, motion, times) if unit > 0.0 else [_start(law)])
        for motion in (_motion(case), _motion(case, turn))
    ]
    for t, *states in zip(times, ways[0][1], ways[1][1], strict=False):
        one, other = (_look(law, load, way[0], state)[0] for way, state in zip(ways, states, strict=True))
        if np.max(np.abs(both @ one - other)) > 1e-6 * (np.max(np.abs(one)) + np.max(np.abs(other))):
            told = f"{one.tolist()}, with the motion turned {other.tolist()}"
            return f"after {t:g} s force and moment are {told}"
    return ""


def _certificate(law: TractionLaw, case: Case) -> str:
    load, motion, state = case["normal_force"], _motion(case), _bent(law, case)
    wrench, _ = _look(law, load, motion, state)
    off = 0.01 * float(np.max(np.abs(wrench))) + 1e-9 * load
    tried = [(wrench, True)] + [(wrench + off * unit, False) for unit in (*np.eye(_WRENCH), *-np.eye(_WRENCH))]
    for told, expected in tried:
        arguments: Any = tuple(motion.tolist()), tuple(state.tolist()), load, tuple(told.tolist()), 0.1 * off
        if bool(law.is_fulfilled(*arguments)) is not expected:
            word = "refuses" if expected else "accepts"
            return f"is_fulfilled {word} {told.tolist()}, where the law has {wrench.tolist()}"
    return ""


def _moves(law: TractionLaw, case: Case) -> str:
    load, motion = case["normal_force"], _motion(case)
    start, size = np.concatenate([motion, _start(law)]), float(np.max(np.abs(motion)))
    scale = np.concatenate([np.full(_WRENCH, size), _scale(law)])

    def slope(y: Array) -> Array:
        # mass and moments of inertia are 1
        return np.concatenate(_look(law, load, y[:_WRENCH], y[_WRENCH:]))

    quick = fastest(slope, start, scale)
    filling = _filling(law, load, motion)
    longest = _TURNS / quick if quick > 0.0 else 1.0
    duration = min(_TIMES * filling, longest) if filling > 0.0 else longest
    wanted = followed(slope, start, scale, [duration])[-1, :_WRENCH]
    puck = Puck(length=size * duration, speed=size)
    u = (motion[0], motion[1], 0.0, *motion[2:])
    solution = run(puck, -size * duration, u, (Cushion(load), law, None), duration, gravity=load)
    given = np.delete(solution.u_end, 2)
    change = float(np.max(np.abs(wanted - motion)))
    if np.max(np.abs(given - wanted)) > _SAME * change + _STEPS * size:
        return f"after {duration:g} s it moves at {given.tolist()}, by an independent integration {wanted.tolist()}"
    return ""
