"""Numbers of one impact."""

from __future__ import annotations

from typing import final

from nonsmooth.engine.memory.declare import FloatRow, IntegerRow, Life, Part, floats, integers, question, real, whole
from nonsmooth.engine.memory.layout import IMPACT_STATE, N_STAGES
from nonsmooth.engine.memory.sizes import impulse_numbers, map_numbers, per

_IMPACT = Life.IMPACT


@final
class Impact(Part, key="impact"):
    """Numbers of one impact, or of one window of a large impact."""

    lone_contact: int = whole(_IMPACT, "Active contact whose impulse is the clock, or -1.")
    is_step_implicit: bool = question(_IMPACT, "The step of the impact is implicit, so that slips may reverse in it.")
    may_be_lone: bool = question(_IMPACT, "One contact may become the clock.")
    phases_kept: int = whole(_IMPACT, "Number of phases before a contact became the clock.")
    slow_steps: int = whole(_IMPACT, "Number of steps in a row with a slip next to rest.")
    speed_scale: float = real(_IMPACT, "m/s", "Largest speed of the impact.")
    rest_speed: float = real(_IMPACT, "m/s", "Slip that counts as rest.")
    h: float = real(_IMPACT, "", "Step with which the next window begins, in pseudo-time.")
    faint_rate: float = real(_IMPACT, "1", "Approach that begins a phase in a window, over the largest speed.")
    n_colliding: int = whole(_IMPACT, "Number of contacts of the whole impact.")
    colliding: IntegerRow = integers(_IMPACT, per(1, "n_slots"), "Contacts of the whole impact.")
    chain: IntegerRow = integers(_IMPACT, per(2, "n_slots"), "Next entry in an articulation's list of contacts.")
    u: FloatRow = floats(_IMPACT, per(1, "n_u"), "", "Velocities between windows of a large impact.")
    n_guards: int = whole(_IMPACT, "Number of guards of the impact.")
    rates: FloatRow = floats(_IMPACT, per(3, "n_slots"), "m/s", "Rates of the active contacts.")
    rates_before: FloatRow = floats(_IMPACT, per(3, "n_slots"), "m/s", "Rates of the active contacts before impact.")
    impulse: FloatRow = floats(_IMPACT, impulse_numbers, "N s", "Impulses of the active contacts.")
    map_block: FloatRow = floats(_IMPACT, map_numbers, "", "What an impact law that maps velocities is given.")
    y: FloatRow = floats(_IMPACT, per(IMPACT_STATE, "n_slots"), "", "State of the impact.", is_late=True)
    y_new: FloatRow = floats(_IMPACT, per(IMPACT_STATE, "n_slots"), "", "State at the end of the step.", is_late=True)
    y_stage: FloatRow = floats(_IMPACT, per(IMPACT_STATE, "n_slots"), "", "State of a stage.", is_late=True)
    y_guess: FloatRow = floats(_IMPACT, per(IMPACT_STATE, "n_slots"), "", "Guess of an implicit stage.", is_late=True)
    y_kept: FloatRow = floats(
        _IMPACT, per(IMPACT_STATE, "n_slots"), "", "State before a contact became the clock.", is_late=True
    )
    slopes: FloatRow = floats(_IMPACT, per(IMPACT_STATE * N_STAGES, "n_slots"), "", "Slopes of stages.", is_late=True)
