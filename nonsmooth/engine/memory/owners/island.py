"""Numbers of the motion: state, and what the next step starts from."""

from __future__ import annotations

import math
from typing import final

from nonsmooth.engine.memory.declare import (
    FloatRow,
    IntegerRow,
    Life,
    Singleton,
    floats,
    integers,
    one_of,
    question,
    real,
    whole,
)
from nonsmooth.engine.memory.layout import N_STAGES
from nonsmooth.engine.memory.modes import Limit
from nonsmooth.engine.memory.sizes import (
    coordinates_and_velocities,
    delassus_blocks,
    delassus_numbers,
    ends,
    history_entries,
    jacobian_numbers,
    per,
    spans,
    step_part_numbers,
)

_STATE, _REUSED, _DERIVED, _STEP = Life.STATE, Life.REUSED, Life.DERIVED, Life.STEP


@final
class Island(Singleton, key="island"):
    """The motion of what one clock drives: today the whole system."""

    # --- state --------------------------------------------------------------------------------------------------------
    time: float = real(_STATE, "s", "Time.")
    y: FloatRow = floats(_STATE, per(1, "n_y"), "", "Integrated state: q, u, energy accounts, inner states of laws.")
    n_contacts: int = whole(_STATE, "Number of listed contacts.", below=ends("n_slots"))
    n_histories: int = whole(
        _STATE, "Number of histories from which the next list is made; 0 once it is made.", below=ends("n_slots")
    )
    list_margin: float = real(_STATE, "m", "Margin of the neighbour list.")
    sphere_order: IntegerRow = integers(
        _STATE, per(1, "n_spheres"), "Bounding spheres, sorted along the axis of the sweep.", below=per(1, "n_spheres")
    )
    follows_a_step: bool = question(_STATE, "No event has come since the last step.")
    free_step: float = real(_STATE, "s", "Next step while no contact is closed.")
    closed_step: float = real(_STATE, "s", "Next step while a contact is closed.")
    first_step: float = real(_STATE, "s", "Largest first step after an event.")
    resumed_step: float = real(_STATE, "s", "Step that was cut off by the end of the last call.")
    resumed_end: float = real(_STATE, "s", "End time of the last call.")
    burst: float = real(_STATE, "1", "Evaluations in the present burst of events, decaying with time.")
    burst_time: float = real(_STATE, "s", "Time at which the burst was evaluated.")
    burst_evaluations: int = whole(_STATE, "Evaluations of forces up to then.")
    averaged_until: float = real(_STATE, "s", "End of the averaging of forces, infinite if none are.", begin=math.inf)
    last_feature_change: float = real(_STATE, "s", "Time of the last change of features.", begin=-math.inf)
    last_choice: float = real(_STATE, "s", "Time of the last choice of redundant forces.", begin=-math.inf)
    own_step: float = real(_STATE, "s", "Next step of a body with a step of its own.")
    own_steps_end: float = real(_STATE, "s", "First end of a step of a body's own.", begin=math.inf)
    has_energy_account: bool = question(_STATE, "The energy before the motion is known.")
    kinetic_before: float = real(_STATE, "J", "Kinetic energy when the account was opened.")
    potential_before: float = real(_STATE, "J", "Potential energy when the account was opened.")
    accounted_before: float = real(_STATE, "J", "Energy that was accounted for when the account was opened.")

    # --- what the next step starts from -------------------------------------------------------------------------------
    velocities: int = whole(_DERIVED, "Where the velocities of all bodies are, on which kinematics is evaluated.")
    driven_time: float = real(_REUSED, "s", "Time at which driven bodies were evaluated.", begin=-math.inf)
    free_time: float = real(_REUSED, "s", "Time at which free bodies were evaluated.", begin=math.nan)
    du: FloatRow = floats(_REUSED, per(1, "n_u"), "", "Accelerations of all bodies.")
    du_free: FloatRow = floats(_REUSED, per(1, "n_u"), "", "Contact-free accelerations.")
    u_free: FloatRow = floats(_REUSED, per(1, "n_u"), "", "Velocities on which joints prescribe nothing.")
    y_evaluated: FloatRow = floats(_REUSED, coordinates_and_velocities, "", "q and u at which bodies were evaluated.")
    n_grouped: int = whole(_DERIVED, "Number of contacts in groups.")
    n_groups: int = whole(_DERIVED, "Number of groups of contacts that act on one another.")
    grouped: IntegerRow = integers(_DERIVED, per(1, "n_slots"), "Contacts in groups, group after group.")
    group_start: IntegerRow = integers(_DERIVED, ends("n_slots"), "Where each group begins in `grouped`.")
    history_places: IntegerRow = integers(
        _STEP, history_entries, "Hash table of the histories by declared number: 1 + index, 0 for a free place."
    )
    group_next: IntegerRow = integers(_STEP, per(1, "n_slots"), "Where the next contact of each group goes.")
    block_start: IntegerRow = integers(_DERIVED, ends("n_slots"), "First Delassus block of each grouped contact.")
    block_column: IntegerRow = integers(
        _DERIVED, delassus_blocks, "Active contact that each Delassus block couples with.", is_late=True
    )
    delassus: FloatRow = floats(_REUSED, delassus_numbers, "1/kg", "Delassus blocks, rows n, t1, t2.", is_late=True)
    jacobians: FloatRow = floats(_REUSED, jacobian_numbers, "", "Jacobians and responses, contact after contact.")
    n_integrated: int = whole(_DERIVED, "Number of bodies that the integrator steps.")
    integrated: IntegerRow = integers(_DERIVED, per(1, "n_bodies"), "Bodies that the integrator steps.")
    n_ballistic: int = whole(_DERIVED, "Number of bodies in ballistic motion.")
    ballistic: IntegerRow = integers(_DERIVED, per(1, "n_bodies"), "Bodies in ballistic motion.")
    n_spans: int = whole(_DERIVED, "Number of spans of the state that the integrator steps.")
    span_first: IntegerRow = integers(_DERIVED, spans, "First entry of each span.")
    span_length: IntegerRow = integers(_DERIVED, spans, "Length of each span.")
    n_spinning: int = whole(_REUSED, "Number of bodies whose spin is integrated apart.", below=ends("n_bodies"))
    spinning: IntegerRow = integers(
        _REUSED, per(1, "n_bodies"), "Bodies whose spin is integrated apart.", below=per(1, "n_bodies")
    )
    singular_contact: int = whole(
        _REUSED, "Contact whose slip is near the Painleve singularity, or -1.", begin=-1, below=per(1, "n_slots")
    )
    stray_contact: int = whole(
        _REUSED,
        "Contact whose averaged forces differ most from those of the motion.",
        begin=-1,
        below=per(1, "n_slots"),
    )
    strayed: float = real(_REUSED, "1", "That difference, relative to its bound.")
    stage_time: float = real(_REUSED, "s", "Time of an implicit stage, 0 if there is none.")
    fastest_turn: float = real(_REUSED, "1/s", "Largest turning rate of a body.")
    power_at_end: float = real(_REUSED, "W", "Power of gravity on ballistic bodies at the end of the step.")
    slopes: FloatRow = floats(_REUSED, per(N_STAGES, "n_y"), "", "Stage slopes; the last one is the next step's first.")
    spin_slopes: FloatRow = floats(_REUSED, per(3 * N_STAGES, "n_bodies"), "1/s^2", "Spin slopes of the stages.")
    spin_start: FloatRow = floats(_REUSED, per(3, "n_bodies"), "1/s", "Spins at the start of the step.")
    quaternion_length: FloatRow = floats(_REUSED, per(1, "n_bodies"), "1", "Lengths of quaternions before normalising.")
    own_start: FloatRow = floats(
        _STATE, per(1, "n_y"), "", "State at the start of steps of bodies with their own step."
    )
    own_slopes: FloatRow = floats(_STATE, per(N_STAGES, "n_y"), "", "Slopes of these steps.")


@final
class Step(Singleton, key="step"):
    """Numbers of one step."""

    limit: Limit = one_of(Limit, _STEP, "What limited the step.")
    h: float = real(_STEP, "s", "Length of the step.")
    listed_step: float = real(_STEP, "s", "Longest step for which the neighbour list holds.")
    closing_step: float = real(_STEP, "s", "Longest step by the gaps that close.")
    turning_step: float = real(_STEP, "s", "Longest step by the turning of the bodies.")
    arrival_step: float = real(_STEP, "s", "Longest step by gaps of ballistic bodies that close.")
    error: float = real(_STEP, "1", "Error of the step, relative to its tolerance.")
    relaxation: float = real(_STEP, "1/s", "Largest rate at which friction laws and slip velocities relax.")
    halting_contact: int = whole(_STEP, "Contact whose slip ends the step, or -1.")
    driven_power: float = real(_STEP, "W", "Power of driven bodies.")
    load_power: float = real(_STEP, "W", "Power of loads.")
    guard: int = whole(_STEP, "Guard that fired, or -1.")
    meeting: int = whole(_STEP, "Pair of parts that meet at the end of the step, or -1.")
    is_undecided: bool = question(_STEP, "Too many evaluations are needed to see whether a gap closes in the step.")
    guard_slope: float = real(_STEP, "", "Slope of that guard at its root, in the unit of the guard per second.")
    has_doubtful_force: bool = question(_STEP, "A stage had a force of the wrong sign.")
    uses_last_slope: bool = question(_STEP, "The first slope is the last one of the step before.")
    has_replaced_slope: bool = question(_STEP, "An implicit step has replaced the first slope.")
    is_blended: bool = question(_STEP, "Redundant forces are blended over the step.")
    n_may_close: int = whole(_STEP, "Number of gaps that may close in the step.")
    may_close: IntegerRow = integers(_STEP, per(1, "n_slots"), "Contacts whose gap may close in the step.")
    power_at_start: float = real(_STEP, "W", "Power of gravity on ballistic bodies at the start of the step.")
    ballistic_exchange: float = real(_STEP, "J", "Energy that ballistic bodies exchange with gravity in the step.")
    y_new: FloatRow = floats(_STEP, per(1, "n_y"), "", "State at the end of the step.")
    y_stage: FloatRow = floats(_STEP, per(1, "n_y"), "", "State of a stage.")
    y_scale: FloatRow = floats(Life.PARAMETER, per(1, "n_y"), "", "Scale of each entry of the state.")
    y_guess: FloatRow = floats(_STEP, per(1, "n_y"), "", "First guess of an implicit stage.")
    first_slope: FloatRow = floats(_STEP, per(1, "n_y"), "", "First slope, while an implicit step replaces it.")
    part_ends: FloatRow = floats(_STEP, step_part_numbers, "", "Ends of the parts of a step in search of a root.")
