"""Properties of friction laws with inner states, beside those of any friction law."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from nonsmooth.binding.compile import parameter_names
from nonsmooth.interfaces import StatefulFrictionLaw
from nonsmooth.testing.callers import compiled_caller, plain_caller
from nonsmooth.testing.coefficient import FORCE, HEADING, SPEED, along, mu
from nonsmooth.testing.component import variants
from nonsmooth.testing.draws import Case, Variable
from nonsmooth.testing.examine import FEWEST, Trial, examine
from nonsmooth.testing.functions import Function
from nonsmooth.testing.property import NotChecked, Row
from nonsmooth.testing.puck import Array, Puck, run
from nonsmooth.testing.reference import Rigid, Spring
from nonsmooth.testing.states import check_start, fastest, followed, misplaced, written

_DRAWS = 10
_TRIED = (0.0, 1e-9, 1e-3, 1.0, 1e2)
_PERIODS = 20.0
"""How long motions are compared, in units of the fastest time of the states."""
_SLOWED = 0.3
"""Part of the slip velocity that friction takes in this time, if the load can be so large."""
_LARGEST_LOAD = 1e3
_SAME, _STEPS = 1e-5, 1e-7
"""Deviations: of the change, and of the whole, by the engine's tolerance of 1e-9 per step."""


def state_rows(law: StatefulFrictionLaw) -> list[Row]:
    """Return the properties of the states."""

    def row(name: str, says: str, trial: Trial, *space: Variable, fewest: int | None = None) -> Row:
        return name, says, lambda: examine(name, variants(law), space, trial, _DRAWS, fewest=fewest)

    speeds = [Variable(f"speed_{i}", 1e-9, 1.0, 0.1, log=True) for i in (1, 2)]
    times = [Variable(f"duration_{i}", 1e-3, 1e2, 1.0, log=True) for i in (1, 2, 3)]
    return [
        row("writes its block", "it writes the rate of every state and nothing else", _writes, SPEED),
        row(
            "states that are reached",
            "through two speeds and a rest the states stay finite, and the coefficient with them not negative",
            _reached,
            *speeds,
            *times,
        ),
        row(
            "certificate with states",
            "it takes the states: a force on the edge of the disc that they give obeys it, one off it does not",
            _certifies,
            SPEED,
            HEADING,
            FORCE,
            Variable("moved", -1.0, 1.0, 1.0),
        ),
        row(
            "sustained motion",
            "a mass that slides in the engine is slowed as an independent integration of motion and states has it",
            _slides,
            SPEED,
            fewest=FEWEST,
        ),
    ]


def start_row(law: StatefulFrictionLaw) -> Row:
    """Return the property of the initial states, without which nothing else is looked at."""
    return (
        "initial state",
        "initial states and scales are as many, finite, the scales positive, and the coefficient takes `state`",
        lambda: examine("initial state", variants(law), (), _starts, 1),
    )


def rates_function(law: StatefulFrictionLaw) -> Function:
    """Return the rates with speeds and states to try."""
    if found := _starts(law, {}):
        raise NotChecked(f"not checked, as {found}")
    n, offered = len(law.initial_state), law.parameters()
    states = [np.array(law.initial_state) + share * np.array(law.state_scale) for share in (0.0, 0.3, 1.0, 30.0)]
    inputs = [(f"{speed:g}, {state.tolist()}", (speed, state)) for speed in _TRIED for state in states]

    def called(call: Callable[..., Any]) -> Callable[[Any], Array]:
        return lambda at: written(lambda out: call(at[0], at[1].copy(), out), n)

    return Function(
        law,
        "rates",
        law.rates,
        "rates",
        offered,
        called(plain_caller(law.rates, "rates", offered)),
        lambda: called(compiled_caller(law.rates, "rates", offered, type(law).__name__)),
        inputs,
    )


def _rates(law: StatefulFrictionLaw, speed: float, state: Array) -> Array:
    call = plain_caller(law.rates, "rates", law.parameters())
    return written(lambda out: call(speed, state, out), len(state))[: len(state)]


def _mu(law: StatefulFrictionLaw, speed: float, state: Array) -> float:
    values = {**law.parameters(), "state": tuple(state.tolist())}
    return float(plain_caller(law.coefficient, "scalar", values)(speed))


def _starts(law: StatefulFrictionLaw, case: Case) -> str:
    names = parameter_names(law.coefficient, "scalar")
    if "state" not in names:
        return f"coefficient takes {', '.join(names) or 'nothing'} beside the speed"
    return check_start(law.initial_state, law.state_scale)


def _writes(law: StatefulFrictionLaw, case: Case) -> str:
    call, state = plain_caller(law.rates, "rates", law.parameters()), np.array(law.initial_state)
    return misplaced(lambda state, out: call(case["slip_speed"], state, out), [state], len(state))


def _reached(law: StatefulFrictionLaw, case: Case) -> str:
    state, scale = np.array(law.initial_state), np.array(law.state_scale)
    for i, speed in enumerate((case["speed_1"], 0.0, case["speed_2"]), start=1):
        duration = case[f"duration_{i}"]
        state = followed(lambda z, v=speed: _rates(law, v, z), state, scale, [duration], stiff=True)[-1]  # type: ignore[misc]
        rest, slow, fast = (_mu(law, at, state) for at in (0.0, 1e-300, speed))
        where = f"after {duration:g} s at {speed:g} m/s, with the states {state.tolist()},"
        if not (np.all(np.isfinite(state)) and math.isfinite(rest + fast) and min(rest, fast) >= 0.0):
            return f"{where} the coefficient is {rest:g} at rest and {fast:g} at this speed"
        if slow > rest * (1.0 + 1e-12) + 1e-12:
            return f"{where} the coefficient is {rest:g} at rest, below {slow:g} of incipient slip"
    return ""


def _certifies(law: StatefulFrictionLaw, case: Case) -> str:
    speed, heading, force = case["slip_speed"], case["heading"], case["normal_force"]
    start, scale = np.array(law.initial_state), np.array(law.state_scale)
    state = start + 10.0 ** case["moved"] * scale
    slip, tolerance = along(speed, heading), 1e-9 * force
    bound = _mu(law, speed, state) * force
    for share, expected in ((-1.0, True), *((share, False) for share in (1.0, -1.001, -0.999) if bound > 1e-5 * force)):
        given = law.is_fulfilled(slip, force, along(share * bound, heading), tolerance, tuple(state.tolist()))
        if bool(given) is not expected:
            word = "refuses" if expected else "accepts"
            return f"is_fulfilled {word} {share:g} of the bound {bound:g} N along the slip, states {state.tolist()}"
    return ""


def _slides(law: StatefulFrictionLaw, case: Case) -> str:
    speed, scale = case["slip_speed"], np.array([*law.state_scale, case["slip_speed"]])
    start = np.array([*law.initial_state, speed])
    quick = fastest(lambda z: _rates(law, speed, z), start[:-1], scale[:-1])
    duration, largest = _PERIODS / quick if quick > 0.0 else 1.0, mu(law, speed)
    load = min(_SLOWED * speed / (largest * duration), _LARGEST_LOAD) if largest > 0.0 else _LARGEST_LOAD

    def end() -> float:
        return float(followed(slope, start, scale, [duration])[-1, -1])

    def slope(y: Array) -> Array:
        return np.append(_rates(law, abs(float(y[-1])), y[:-1]), -load * _mu(law, abs(float(y[-1])), y[:-1]))

    # friction may grow by much on the way: the mass must not stop
    while (wanted := end()) < (1.0 - 2.0 * _SLOWED) * speed:
        load *= _SLOWED
    puck, u = Puck(length=speed * duration, speed=speed), (speed, 0.0, 0.0, 0.0, 0.0, 0.0)
    given = float(run(puck, 0.0, u, (Rigid(), law, Spring()), duration, gravity=load).u_end[0])
    if abs(given - wanted) > _SAME * abs(speed - wanted) + _STEPS * speed:
        return (
            f"after {duration:g} s under {load:g} N a mass of 1 kg has {given:.9g} m/s, "
            f"by an independent integration {wanted:.9g} m/s"
        )
    return ""
