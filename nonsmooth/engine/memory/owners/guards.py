"""Numbers of guards: functions whose roots end a step."""

from __future__ import annotations

from typing import final

from nonsmooth.engine.memory.declare import Life, Record, address, question, real, whole
from nonsmooth.engine.memory.layout import IMPACT_GUARDS
from nonsmooth.engine.memory.sizes import all_guards, per

_STEP, _REUSED, _IMPACT = Life.STEP, Life.REUSED, Life.IMPACT


@final
class GuardRecord(Record, key="guards", capacity=all_guards, length="model.n_slots"):
    """A guard of the motion: the normal, friction and end guards of the contacts, and those of the user."""

    value: float = real(_STEP, "", "Value where it was evaluated last.")
    middle: float = real(_STEP, "", "Value in the middle of the step.")
    initial: float = real(_STEP, "", "Value at the start of the step, or its growth if it is deflated.")
    base: float = real(_STEP, "", "Value from which its growth counts if it is deflated.")
    at_end: float = real(_REUSED, "", "Value at the end of the step.")
    is_armed: bool = question(_STEP, "It was positive, so that it may fire.")
    is_deflated: bool = question(_STEP, "It starts about zero: its growth is watched in place of its value.")


@final
class OwnGuard(Record, key="own_guards", capacity="n_own_guards", length="model.n_own_guards"):
    """A guard that the user declared."""

    function: int = address(Life.PARAMETER, "Address of the function of time, q and u.")
    parameters: int = whole(Life.PARAMETER, "Offset of the parameters of that function.")
    has_just_fired: bool = question(Life.STATE, "It fired at the last event.")
    ends_the_run: bool = question(Life.PARAMETER, "The run ends when it fires.")


@final
class ImpactGuard(Record, key="impact_guards", capacity=per(IMPACT_GUARDS, "n_slots"), length="impact.n_guards"):
    """A guard of an impact: three of every active contact, those of its rate, its energy and its friction."""

    value: float = real(_IMPACT, "1", "Value where it was evaluated last.")
    at_start: float = real(_IMPACT, "1", "Value at the start of the step.")
    is_armed: bool = question(_IMPACT, "It was positive in its phase, so that it may fire.")
