"""Conformance checks of laws of traction: force and moment, inner states, and motion in the engine.

Each claim states a property in its docstring. It returns or raises a message if the property fails, else "" or None.
"""

from __future__ import annotations

import functools
import math
from typing import Any

import numpy as np

from nonsmooth.engine.memory.blocks import FORCE_AND_MOMENT
from nonsmooth.interfaces import TractionLaw
from nonsmooth.system.materials import ContactLaws
from nonsmooth.testing.claims import FEWEST, Claims, claim, rows, wrong_verdict
from nonsmooth.testing.component import variants
from nonsmooth.testing.differences import jump
from nonsmooth.testing.functions import CheckedFunction, all_rows, plain_caller, written
from nonsmooth.testing.inputs import Case, Drawn, DrawnNumber, draws, number
from nonsmooth.testing.outcome import Row
from nonsmooth.testing.property import Property, properties
from nonsmooth.testing.puck import ConstantLoad, Puck, run
from nonsmooth.testing.reference import fastest, followed, is_same_motion, require, start_fault, start_of, writing_fault
from nonsmooth.types import Array

_DRAWS = 8
_LOAD = number("normal_force", 1e-2, 1e2, 1.0, is_log=True)
_NUMBERS = (
    DrawnNumber("slip_speed", 1e-3, 1.0, 1.0, is_log=True),
    DrawnNumber("heading", -3.1, 3.1),
    DrawnNumber("rolling", 0.0, 3.0),
    DrawnNumber("rolling_heading", -3.1, 3.1),
    DrawnNumber("drilling", -3.0, 3.0),
)
_MOTION = Drawn(_NUMBERS, lambda case: _motion(case))
_BENT = number("bent", -2.0, 2.0)
_TURN = number("turn", -3.1, 3.1, 1.0)
_LONG, _SHORT = 40.0, 0.5
"""Times after the closing of a contact: a long one, at which traction is steady, and a short one, at which traction
still changes. Their unit is the time in which the inner states reach their usual sizes (``_filling``)."""
_SAMPLES = 20
_TIMES, _TURNS = 5.0, 60.0
"""Two limits for the duration of a motion that is compared with an independent integration; the shorter one is used.
``_TIMES`` is in units of the time in which the inner states reach their usual sizes. ``_TURNS`` is in units of the
shortest time constant of the motion."""
_TRACTION = Claims()


def check_traction_law(law: TractionLaw) -> list[Property]:
    """Return the properties of a law of traction.

    Parameters
    ----------
    law : TractionLaw
        The law, with parameters.
    """
    return properties(law, _rows)


def _rows(law: TractionLaw) -> list[Row]:
    table = functools.partial(rows, components=lambda: variants(law), count=_DRAWS)
    return all_rows(law, lambda: [_traction(one) for one in variants(law)], table(_TRACTION), table([_initial_state]))


def _motion(case: Case) -> Array:
    """Return slip, rolling and drilling velocities of an input, shape [5]."""
    c, s = math.cos(case["rolling_heading"]), math.sin(case["rolling_heading"])
    slip, rolling = case["slip_speed"], case["rolling"]
    along = slip * math.cos(case["heading"]), slip * math.sin(case["heading"])
    return np.array([*along, rolling * c, rolling * s, case["drilling"]])


def _turn_of(angle: float) -> Array:
    """Return the matrix that turns tangential vectors by an angle about the normal [rad], shape [5, 5].

    It acts on force and moment, or on slip, rolling and drilling; the components about the normal stay the same.
    """
    c, s = math.cos(angle), math.sin(angle)
    both = np.eye(FORCE_AND_MOMENT)
    both[:2, :2] = both[2:4, 2:4] = [[c, -s], [s, c]]
    return both


def _traction(law: TractionLaw) -> CheckedFunction:
    require(start_fault(law))
    start, scale = start_of(law)
    motions = [np.zeros(FORCE_AND_MOMENT), *(_motion(case) for case in draws([_MOTION], 4))]
    inputs = [
        (f"{load:g}, {motion.tolist()}, {state.tolist()}", (load, motion, state))
        for load in (0.0, 1.0, -1.0, 100.0)
        for motion in motions
        for state in (start + share * scale for share in (0.0, 0.7, -3.0))
    ]
    return CheckedFunction(law, "traction", "traction", law.parameters(), inputs, FORCE_AND_MOMENT + len(start))


def _look(law: TractionLaw, load: float, motion: Array, state: Array) -> tuple[Array, Array]:
    """Return force with moment, shape [5], and the rates of the states, shape [n_states]."""
    n, call = FORCE_AND_MOMENT + len(state), plain_caller(law.traction, "traction", law.parameters())
    out = written(lambda out: call(load, motion, state, out), n)
    return out[:FORCE_AND_MOMENT], out[FORCE_AND_MOMENT:n]


def _bent(law: TractionLaw, bent: float) -> Array:
    """Return inner states that differ from the initial states by ``bent`` times their scales, times a fixed factor.

    The factor is a cosine with another value for each state, so that the states differ from each other.
    """
    start, scale = start_of(law)
    return np.asarray(start + bent * np.cos(1.0 + np.arange(len(start))) * scale)


@claim()
def _initial_state(law: TractionLaw) -> str:
    """The initial states are finite, each with a positive scale."""
    return start_fault(law)


@_TRACTION.claim(_LOAD, _MOTION)
def _writes_its_block(law: TractionLaw, load: float, motion: Array) -> str:
    """The law's function writes force, moment and the rate of every state, and nothing else."""
    call, (state, _) = plain_caller(law.traction, "traction", law.parameters()), start_of(law)
    for one in (motion, np.zeros(FORCE_AND_MOMENT)):
        if found := writing_fault(functools.partial(call, load), [one, state], FORCE_AND_MOMENT + len(state)):
            return found
    return ""


@_TRACTION.claim(_LOAD, _MOTION, _BENT)
def _no_jumps(law: TractionLaw, load: float, motion: Array, bent: float) -> str:
    """Force, moment and rates are continuous in load, motion and states."""
    state, (_, scale) = _bent(law, bent), start_of(law)

    def moved(share: float) -> Array:
        wrench, rates = _look(law, load, share * motion, state)
        return np.concatenate([wrench, rates / scale])

    def loaded(share: float) -> Array:
        return _look(law, share * load, motion, state)[0]

    for words, function in (("motion", moved), ("load", loaded)):
        if (found := jump(function, -1.0, 1.0)) is not None:
            return f"at {found[0]:.6g} times this {words} it jumps by {found[1].tolist()}"
    return ""


@_TRACTION.claim(_MOTION, _BENT)
def _nothing_without_load(law: TractionLaw, motion: Array, bent: float) -> str:
    """Without normal force there is no traction."""
    wrench, _ = _look(law, 0.0, motion, _bent(law, bent))
    return f"force and moment are {wrench.tolist()}" if np.any(wrench != 0.0) else ""


def _filling(law: TractionLaw, load: float, motion: Array) -> float:
    """Return the time in which the inner states reach their usual sizes in a motion [s]; zero without states."""
    start, scale = start_of(law)
    rates = np.abs(_look(law, load, motion, start)[1])
    return float(np.max(scale[rates > 0.0] / rates[rates > 0.0], initial=0.0))


def _through(law: TractionLaw, load: float, motion: Array, times: list[float]) -> list[Array]:
    """Return force with moment during a motion at constant velocity, at rising times after the contact closes [s]."""
    start, scale = start_of(law)
    states = [start]
    if times[-1] > 0.0:
        states = [*followed(lambda z: _look(law, load, motion, z)[1], start, scale, times, stiff=True)]
    return [_look(law, load, motion, state)[0] for state in states]


@_TRACTION.claim(_LOAD, _MOTION)
def _dissipation(law: TractionLaw, load: float, motion: Array) -> str:
    """In a motion at constant velocity, traction adds no energy on average."""
    times = _filling(law, load, motion) * np.linspace(0.5 * _LONG, _LONG, _SAMPLES)
    wrenches = _through(law, load, motion, times.tolist())
    mean = float(np.mean([wrench @ motion for wrench in wrenches]))
    gross = max(float(np.abs(wrench) @ np.abs(motion)) for wrench in wrenches)
    return f"in the long run it gives {mean:g} W" if mean > 1e-9 * gross else ""


@_TRACTION.claim(_LOAD, _MOTION, _TURN)
def _frame_invariance(law: TractionLaw, load: float, motion: Array, angle: float) -> str:
    """If the motion is turned about the normal, force and moment turn with it at all times after closing."""
    unit, turn = _filling(law, load, motion), _turn_of(angle)
    times = [_SHORT * unit, _TIMES * unit]
    ways = (_through(law, load, one, times) for one in (motion, turn @ motion))
    for t, one, other in zip(times, *ways, strict=False):
        if np.max(np.abs(turn @ one - other)) > 1e-6 * (np.max(np.abs(one)) + np.max(np.abs(other))):
            return f"after {t:g} s force and moment are {one.tolist()}, with the motion turned {other.tolist()}"
    return ""


@_TRACTION.claim(_LOAD, _MOTION, _BENT)
def _certificate(law: TractionLaw, load: float, motion: Array, bent: float) -> str:
    """The law accepts the force and moment that it computes, and refuses them if a component differs by a hundredth."""
    state = _bent(law, bent)
    wrench, _ = _look(law, load, motion, state)
    off = 0.01 * float(np.max(np.abs(wrench))) + 1e-9 * load
    axes = np.eye(FORCE_AND_MOMENT)
    tried = [(wrench, True)] + [(wrench + off * axis, False) for axis in (*axes, *-axes)]
    for given, expected in tried:
        arguments: Any = tuple(motion.tolist()), tuple(state.tolist()), load, tuple(given.tolist()), 0.1 * off
        if verdict := wrong_verdict(law.is_fulfilled(*arguments), expected):
            return f"{verdict} {given.tolist()}, where the law has {wrench.tolist()}"
    return ""


@_TRACTION.claim(_LOAD, _MOTION, fewest=FEWEST)
def _sustained_motion(law: TractionLaw, load: float, motion: Array) -> str:
    """A body that slides, rolls and drills moves in the engine as in an independent integration of its motion."""
    state, state_scale = start_of(law)
    start, size = np.concatenate([motion, state]), float(np.max(np.abs(motion)))
    scale = np.concatenate([np.full(FORCE_AND_MOMENT, size), state_scale])

    def slope(y: Array) -> Array:
        # mass and moments of inertia are 1
        return np.concatenate(_look(law, load, y[:FORCE_AND_MOMENT], y[FORCE_AND_MOMENT:]))

    quick, filling = fastest(slope, start, scale), _filling(law, load, motion)
    longest = _TURNS / quick if quick > 0.0 else 1.0
    duration = min(_TIMES * filling, longest) if filling > 0.0 else longest
    wanted = followed(slope, start, scale, [duration])[-1, :FORCE_AND_MOMENT]
    puck, u = Puck(length=size * duration, speed=size), np.insert(motion, 2, 0.0)
    laws = ContactLaws(ConstantLoad(load), law)
    given = np.delete(run(puck, -size * duration, u, laws, duration, gravity=load).u_end, 2)
    if is_same_motion(given, wanted, motion, size):
        return ""
    return f"after {duration:g} s it moves at {given.tolist()}, by an independent integration {wanted.tolist()}"
