"""Conformance checks of friction laws with inner states, in addition to the checks of every friction law."""

from __future__ import annotations

import math

import numpy as np

from nonsmooth.binding.compile import parameter_names
from nonsmooth.interfaces import StatefulFrictionLaw
from nonsmooth.system.materials import ContactLaws
from nonsmooth.testing.claims import FEWEST, Claims, claim, wrong_verdict
from nonsmooth.testing.coefficient import FORCE, HEADING, SPEED, along, mu
from nonsmooth.testing.functions import CheckedFunction, plain_caller, written
from nonsmooth.testing.inputs import Drawn, DrawnNumber, number
from nonsmooth.testing.puck import Puck, run
from nonsmooth.testing.reference import (
    ReferenceContact,
    ReferenceImpact,
    fastest,
    followed,
    is_same_motion,
    require,
    start_fault,
    start_of,
    writing_fault,
)
from nonsmooth.types import Array

_TRIED = (0.0, 1e-9, 1e-3, 1.0, 1e2)
_MOVED = number("moved", -1.0, 1.0, 1.0)
_SPEEDS = [DrawnNumber(f"speed_{i}", 1e-9, 1.0, 0.1, is_log=True) for i in (1, 2)]
_DURATIONS = [DrawnNumber(f"duration_{i}", 1e-3, 1e2, 1.0, is_log=True) for i in (1, 2, 3)]
_STAGES = Drawn(
    (*_SPEEDS, *_DURATIONS),
    lambda c: [(c["speed_1"], c["duration_1"]), (0.0, c["duration_2"]), (c["speed_2"], c["duration_3"])],
)
"""Drawn pairs (slip speed [m/s], duration [s]) of three stages: sliding, rest, and sliding at another speed. During the
stages, the inner states of a law take various values."""
_PERIODS = 20.0
"""Duration of the motion that is compared with an independent integration, in units of the shortest time constant of
the inner states."""
_SLOWED = 0.3
"""Part of the slip velocity that friction removes in the motion that lasts ``_PERIODS``. It is less if this part would
need a normal force above ``_LARGEST_LOAD``."""
_LARGEST_LOAD = 1e3
"""Largest normal force in the motion that lasts ``_PERIODS`` [N]. It is used for laws with little friction, which
would otherwise need an arbitrarily large force."""
STATES = Claims()
"""Claims about friction laws with inner states."""


def rates_function(law: StatefulFrictionLaw) -> CheckedFunction:
    """Return the rates of the states as a function to check, with speeds and states as inputs."""
    require(initial_state.fault(law, {}))
    start, scale = start_of(law)
    states = [start + share * scale for share in (0.0, 0.3, 1.0, 30.0)]
    inputs = [(f"{speed:g}, {state.tolist()}", (speed, state)) for speed in _TRIED for state in states]
    return CheckedFunction(law, "rates", "rates", law.parameters(), inputs, len(start))


def _rates(law: StatefulFrictionLaw, speed: float, state: Array) -> Array:
    call = plain_caller(law.rates, "rates", law.parameters())
    return written(lambda out: call(speed, state, out), len(state))[: len(state)]


def _mu(law: StatefulFrictionLaw, speed: float, state: Array) -> float:
    values = {**law.parameters(), "state": tuple(state.tolist())}
    return float(plain_caller(law.coefficient, "scalar", values)(speed))


@claim()
def initial_state(law: StatefulFrictionLaw) -> str:
    """The initial states are finite, each with a positive scale, and the coefficient takes the argument `state`."""
    names = parameter_names(law.coefficient, "scalar")
    if "state" not in names:
        return f"coefficient takes {', '.join(names) or 'nothing'} beside the speed"
    return start_fault(law)


@STATES.claim(SPEED)
def _writes_its_block(law: StatefulFrictionLaw, speed: float) -> str:
    """The function of the rates writes the rate of every state and nothing else."""
    call, (state, _) = plain_caller(law.rates, "rates", law.parameters()), start_of(law)
    return writing_fault(lambda state, out: call(speed, state, out), [state], len(state))


@STATES.claim(_STAGES)
def _states_that_are_reached(law: StatefulFrictionLaw, stages: list[tuple[float, float]]) -> str:
    """Through sliding, rest and sliding at another speed, the states stay finite and the coefficient at least 0."""
    state, scale = start_of(law)
    fast_speed = stages[0][0]
    for speed, duration in stages:
        state = followed(lambda z, v=speed: _rates(law, v, z), state, scale, [duration], stiff=True)[-1]  # type: ignore[misc]
        fast_speed = speed or fast_speed
        rest, slow, fast = (_mu(law, at, state) for at in (0.0, 1e-300, fast_speed))
        where = f"after {duration:g} s at {speed:g} m/s, with the states {state.tolist()},"
        if not (np.all(np.isfinite(state)) and math.isfinite(rest + fast) and min(rest, fast) >= 0.0):
            return f"{where} the coefficient is {rest:g} at rest and {fast:g} at {fast_speed:g} m/s"
        if slow > rest * (1.0 + 1e-12) + 1e-12:
            return f"{where} the coefficient is {rest:g} at rest, below {slow:g} of incipient slip"
    return ""


@STATES.claim(SPEED, HEADING, FORCE, _MOVED)
def _certificate_with_states(law: StatefulFrictionLaw, speed: float, heading: float, load: float, moved: float) -> str:
    """The law accepts the force on the friction bound at given inner states, and refuses a force off this bound."""
    start, scale = start_of(law)
    state = start + 10.0**moved * scale
    slip, bound = along(speed, heading), _mu(law, speed, state) * load
    for share in (-1.0, *((1.0, -1.001, -0.999) if bound > 1e-5 * load else ())):
        force, known = along(share * bound, heading), tuple(state.tolist())
        if verdict := wrong_verdict(law.is_fulfilled(slip, load, force, 1e-9 * load, known), share == -1.0):
            return f"{verdict} {share:g} of the bound {bound:g} N along the slip, states {state.tolist()}"
    return ""


@STATES.claim(SPEED, fewest=FEWEST)
def _sustained_motion(law: StatefulFrictionLaw, speed: float) -> str:
    """A mass that slides slows down in the engine as in an independent integration of motion and states."""
    state, state_scale = start_of(law)
    start, scale = np.append(state, speed), np.append(state_scale, speed)
    quick = fastest(lambda z: _rates(law, speed, z), state, state_scale)
    duration, largest = _PERIODS / quick if quick > 0.0 else 1.0, mu(law, speed)
    load = min(_SLOWED * speed / (largest * duration), _LARGEST_LOAD) if largest > 0.0 else _LARGEST_LOAD

    def slope(y: Array) -> Array:
        fast = abs(float(y[-1]))
        return np.append(_rates(law, fast, y[:-1]), -load * _mu(law, fast, y[:-1]))

    # friction may grow during the motion: reduce the load until the mass keeps at least 1 - 2 _SLOWED = 40 % of its
    # speed
    while (wanted := float(followed(slope, start, scale, [duration])[-1, -1])) < (1.0 - 2.0 * _SLOWED) * speed:
        load *= _SLOWED
    puck, u = Puck(length=speed * duration, speed=speed), (speed, 0.0, 0.0, 0.0, 0.0, 0.0)
    laws = ContactLaws(ReferenceContact(), law, ReferenceImpact())
    given = float(run(puck, 0.0, u, laws, duration, gravity=load).u_end[0])
    if is_same_motion(given, wanted, speed, speed):
        return ""
    return (
        f"after {duration:g} s under {load:g} N a mass of 1 kg has {given:.9g} m/s, "
        f"by an independent integration {wanted:.9g} m/s"
    )
