"""Numbers of a contact."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, final

from nonsmooth.engine.memory import blocks
from nonsmooth.engine.memory.declare import (
    Declaration,
    Life,
    Record,
    Vector2,
    Vector3,
    Vector4,
    address,
    declarations,
    end_of,
    one_of,
    question,
    real,
    row,
    vector,
    whole,
)
from nonsmooth.engine.memory.modes import Cause, Mode, Phase
from nonsmooth.engine.memory.sizes import per
from nonsmooth.types import Floats

_PARAMETER, _STATE, _REUSED = Life.PARAMETER, Life.STATE, Life.REUSED
_STEP, _EVENT, _IMPACT = Life.STEP, Life.EVENT, Life.IMPACT
_SLIDE_A, _TURN_A = blocks.SIDE_A + blocks.SLIDE_MATRIX, blocks.SIDE_A + blocks.TURN_MATRIX
_SLIDE_B, _TURN_B = blocks.SIDE_B + blocks.SLIDE_MATRIX, blocks.SIDE_B + blocks.TURN_MATRIX


@final
class ContactRecord(Record, key="contacts", capacity="n_slots", length="island.n_contacts"):
    """A contact of the active list: one pair of features of two bodies that are near each other.

    Directions are n, the normal from the first body to the second, and the tangents t1 and t2.
    """

    # --- what was declared --------------------------------------------------------------------------------------------
    declared: int = whole(_STATE, "Number of the declared contact.", is_of_slot=True, below=per(1, "n_declared"))
    body_a: int = whole(_PARAMETER, "First body.", is_of_row=True)
    body_b: int = whole(_PARAMETER, "Second body.", is_of_row=True)
    articulation_a: int = whole(_PARAMETER, "Articulation of the first body.", is_of_row=True)
    articulation_b: int = whole(_PARAMETER, "Articulation of the second body.", is_of_row=True)
    frame_a: int = whole(_PARAMETER, "Offset of the frame of the first body.", is_of_row=True)
    frame_b: int = whole(_PARAMETER, "Offset of the frame of the second body.", is_of_row=True)
    n_u_a: int = whole(_PARAMETER, "Number of velocities of the first body.", is_of_row=True)
    n_u_b: int = whole(_PARAMETER, "Number of velocities of the second body.", is_of_row=True)
    column_a: int = whole(_PARAMETER, "Column of the first body in the Jacobian of its articulation.", is_of_row=True)
    column_b: int = whole(_PARAMETER, "Column of the second body in the Jacobian of its articulation.", is_of_row=True)
    support_radius_a: float = real(_PARAMETER, "m", "Largest distance of surface a from its origin.", is_of_row=True)
    support_radius_b: float = real(_PARAMETER, "m", "Largest distance of surface b from its origin.", is_of_row=True)
    spin_axis: Vector3 = vector(
        _PARAMETER, 3, "1", "Body axis about which the smaller shape may spin unseen, or zero.", is_of_row=True
    )
    size: float = real(_PARAMETER, "m", "Size of the smaller body.", is_of_row=True)
    contact_time: float = real(_PARAMETER, "s", "Duration of an impact, below which bounces are not resolved.")
    reach: float = real(_PARAMETER, "m", "Gap up to which a compliant contact acts.")
    geometry_function: int = address(_PARAMETER, "Address of the function that writes the geometry.")
    geometry_parameters: int = whole(_PARAMETER, "Offset of the parameters of the geometry.")
    bound_function: int = address(_PARAMETER, "Address of the function that bounds how soon the contact closes, or 0.")
    is_compliant: bool = question(_PARAMETER, "Normal force depends on gap and rate.", inside=("normal_function", 0))
    normal_function: int = address(_PARAMETER, "Address of the normal law of a compliant contact, else 0.")
    geometry: Floats = row(_REUSED, blocks.GEOMETRY, "", "Block that the kinematics writes, by parts below.")
    normal_parameters: int = whole(_PARAMETER, "Offset of the parameters of the normal law.")
    friction_function: int = address(_PARAMETER, "Address of the friction law.")
    friction_parameters: int = whole(_PARAMETER, "Offset of the parameters of the friction law.")
    is_anisotropic: bool = question(_PARAMETER, "Friction depends on the direction.")
    anisotropy: int = whole(_PARAMETER, "Offset of axis and ratios of anisotropic friction.")
    has_traction_law: bool = question(_PARAMETER, "A law gives friction and moment.", inside=("traction_function", 0))
    traction_function: int = address(_PARAMETER, "Address of the traction law, or 0.")
    traction_parameters: int = whole(_PARAMETER, "Offset of the parameters of the traction law.")
    traction_out: int = whole(_PARAMETER, "Offset at which the traction law writes.")
    rates_function: int = address(_PARAMETER, "Address of the function of the rates of inner states, or 0.")
    rates_parameters: int = whole(_PARAMETER, "Offset of the parameters of the rates.")
    rates_out: int = whole(_PARAMETER, "Offset at which the rates of inner states begin.")
    inner_states: int = whole(_PARAMETER, "Offset of the law's inner states in the state.", is_of_row=True)
    n_inner_states: int = whole(_PARAMETER, "Number of inner states of the law.")
    inner_states_at_start: int = whole(_PARAMETER, "Offset of the inner states of a new contact.")
    inner_states_copy: int = whole(_PARAMETER, "Offset of the inner states that the law reads.")
    impact_force_function: int = address(_PARAMETER, "Address of force over deformation in an impact.")
    impact_force_parameters: int = whole(_PARAMETER, "Offset of the parameters of force over deformation.")
    efficiency_function: int = address(_PARAMETER, "Address of the efficiency over the gap rate, Eq. (28).")
    efficiency_parameters: int = whole(_PARAMETER, "Offset of the parameters of the efficiency.")
    map_parameters: int = whole(_PARAMETER, "Offset of the parameters of an impact law that maps velocities.")
    features: int = whole(_PARAMETER, "Offset of the pair of features out of a pool, or 0.")
    pair: int = whole(_PARAMETER, "Pair of convex parts that the contact belongs to, or -1.", is_of_row=True)
    jacobian_a: int = whole(_PARAMETER, "Offset of W^T and N^T of the first body, rows n, t1, t2.", is_of_slot=True)
    jacobian_b: int = whole(_PARAMETER, "Offset of W^T and N^T of the second body.", is_of_slot=True)
    response_a: int = whole(_PARAMETER, "Offset of K W and K N of the first body.", is_of_slot=True)
    response_b: int = whole(_PARAMETER, "Offset of K W and K N of the second body.", is_of_slot=True)

    # --- its history --------------------------------------------------------------------------------------------------
    mode: Mode = one_of(Mode, _STATE, "Open, stick or slide.")
    direction: Vector2 = vector(_STATE, 2, "1", "Unit direction of the slip, or of the slip that begins.")
    facing: int = whole(_STATE, "Side, 1 or -1, from which anisotropic friction is opposed.")
    initial_depth: float = real(_STATE, "m", "Depth at which a foot came over the rim of a face; gaps count from it.")
    closing_rate: float = real(_STATE, "m/s", "Gap rate with which a compliant contact closed.")
    force_round_off: float = real(_STATE, "N", "Normal force that counts as zero.")
    slip_per_force: float = real(_STATE, "1/kg", "Slip acceleration per unit of friction.")
    mode_after_averaging: Mode = one_of(Mode, _STATE, "Mode after averaging, open if not averaged.")
    is_averaged: bool = question(_STATE, "Forces are averaged over a contact time.", inside=("mode_after_averaging", 0))
    mean_force: Floats = row(_STATE, 3, "N", "Averaged force, n, t1, t2, along t1 not stretched.")
    mean_span: float = real(_STATE, "s", "Time over which forces are averaged.")
    mean_gap: float = real(_STATE, "m", "Gap at the start of the averaging span.")
    mean_gap_change: float = real(_STATE, "m", "Change of the gap until it comes to rest.")
    mean_forces_asked: float = real(_STATE, "s", "Time when forces were last tried at an instant.")
    mean_forces_wait: float = real(_STATE, "s", "Time after which the next attempt is made.")
    null_space_force: Floats = row(_STATE, 3, "N", "Chosen part of a force that is not unique.")
    slack: float = real(_STATE, "N", "Excess over the bounds that a choice of forces is allowed.")
    burst_start: float = real(_STATE, "s", "Start of the present burst of events.")
    burst_events: int = whole(_STATE, "Number of events in the present burst.")

    # --- what the next step starts from -------------------------------------------------------------------------------
    gap_at_end: float = real(_REUSED, "m", "Gap at the end of the step.")
    gap_rate_at_end: float = real(_REUSED, "m/s", "Gap rate at the end of the step.")
    velocity_at_end: Vector3 = vector(_REUSED, 3, "m/s", "Gap rate and slip at the end of the step.")
    slip_at_end: Vector2 = vector(_REUSED, 2, "m/s", "Slip at the end of the step.", inside=("velocity_at_end", 1))
    overlap_at_end: float = real(_REUSED, "m", "Overlap at the end of the step.")
    past_feature_at_end: float = real(_REUSED, "m", "Distance past the features at the end of the step.")
    speed_at_end: float = real(_REUSED, "m/s", "Bound of the rate of the gap at the end of the step.")
    acceleration_bound_at_end: Vector3 = vector(
        _REUSED, 3, "m/s^2, m/s^2, 1/s", "Bounds of gap acceleration and turning at the end of the step."
    )
    offset_at_end: Vector3 = vector(_REUSED, 3, "m", "Offset of the contact point from the body at the step's end.")
    is_held_by_friction: bool = question(_REUSED, "Friction holds the contact.")
    has_redundant_force: bool = question(_REUSED, "The force is not unique.")
    static_margin: float = real(_REUSED, "N", "Distance of the friction to its static bound.")
    normal_force: float = real(_REUSED, "N", "Normal contact force.", inside=("force", 0))
    force: Floats = row(_REUSED, 3, "N", "Contact force, n, t1, t2.")
    is_touching: bool = question(_REUSED, "The surfaces touch within the tolerances.")
    group: int = whole(Life.DERIVED, "Island of the contact.")
    gap: float = real(_REUSED, "m", "Gap along the normal, negative in an overlap.", inside=("geometry", blocks.GAP))
    normal: Vector3 = vector(_REUSED, 3, "1", "Normal, from the kinematics.", inside=("geometry", blocks.NORMAL))
    tangent: Vector3 = vector(_REUSED, 3, "1", "Tangent t1, from the kinematics.", inside=("geometry", blocks.TANGENT))
    point_a: Vector3 = vector(_REUSED, 3, "m", "Witness point on the first body.", inside=("geometry", blocks.POINT_A))
    point_b: Vector3 = vector(_REUSED, 3, "m", "Witness point on the second body.", inside=("geometry", blocks.POINT_B))
    slide_a: Vector4 = vector(_REUSED, 4, "1", "Matrix of sliding over surface a.", inside=("geometry", _SLIDE_A))
    turn_a: Vector4 = vector(_REUSED, 4, "m", "Matrix of turning on surface a.", inside=("geometry", _TURN_A))
    slide_b: Vector4 = vector(_REUSED, 4, "1", "Matrix of sliding over surface b.", inside=("geometry", _SLIDE_B))
    turn_b: Vector4 = vector(_REUSED, 4, "m", "Matrix of turning on surface b.", inside=("geometry", _TURN_B))
    axes: Floats = row(_REUSED, 9, "1", "Rows n, t1, t2; of anisotropic friction t1 and t2 are stretched.")
    axis_n: Vector3 = vector(_REUSED, 3, "1", "Row n of the axes.", inside=("axes", 0))
    axis_1: Vector3 = vector(_REUSED, 3, "1", "Row t1 of the axes.", inside=("axes", 3))
    axis_2: Vector3 = vector(_REUSED, 3, "1", "Row t2 of the axes.", inside=("axes", 6))
    stretch_1: Vector2 = vector(_REUSED, 2, "1", "Row t1 along the unit tangents.")
    stretch_2: Vector2 = vector(_REUSED, 2, "1", "Row t2 along the unit tangents.")
    version_a: int = whole(_REUSED, "Evaluation of the first body that the contact was evaluated with.")
    version_b: int = whole(_REUSED, "Evaluation of the second body that the contact was evaluated with.")
    was_evaluated_open: bool = question(_REUSED, "The contact was open when it was evaluated: its gap depends on that.")
    feature_now: float = real(_REUSED, "1", "Number of the features in contact.", inside=("geometry", blocks.FEATURE))
    past_feature: float = real(
        _REUSED, "m", "Distance past the ends of features.", inside=("geometry", blocks.PAST_END)
    )
    overlap: float = real(_REUSED, "m", "Gap where the surfaces overlap, else 0.")
    rate: Floats = row(_REUSED, 3, "m/s", "Gap rate and slip velocity, one by one.")
    velocity: Vector3 = vector(_REUSED, 3, "m/s", "Gap rate and slip velocity, as a tuple.", inside=("rate", 0))
    normal_rate: float = real(_REUSED, "m/s", "Gap rate.", inside=("rate", 0))
    slip: Vector2 = vector(_REUSED, 2, "m/s", "Slip velocity along the rows of the axes.", inside=("rate", 1))
    slip_of_tangents: Vector2 = vector(_REUSED, 2, "m/s", "Slip velocity along the unit tangents.")
    gap_rate_at_start: float = real(_REUSED, "m/s", "Gap rate at the start of the step.")

    # --- a step -------------------------------------------------------------------------------------------------------
    bias: Floats = row(_STEP, 3, "m/s^2", "Acceleration while u' = 0, n, t1, t2.")
    dissipated_by_spin: float = real(_STEP, "W", "Power of the friction moment.")
    compliant_force: float = real(_STEP, "N", "Normal force of a compliant contact.")
    gap_rate: float = real(_STEP, "m/s", "Gap rate where the guards were written last.")
    gap_at_start: float = real(_STEP, "m", "Gap at the start of the step.")
    past_feature_at_start: float = real(_STEP, "m", "Distance past the features at the start of the step.")
    speed_at_start: float = real(_STEP, "m/s", "Bound of the rate of the gap at the start of the step.")
    acceleration_bound_at_start: Vector3 = vector(
        _STEP, 3, "m/s^2, m/s^2, 1/s", "Bounds of gap acceleration and turning at the start of the step."
    )
    offset_at_start: Vector3 = vector(_STEP, 3, "m", "Offset of the contact point from the body at the step's start.")
    closing_time: float = real(_STEP, "s", "Expected time until the gap of bodies in flight closes.")
    least_force: float = real(_STEP, "N", "Smallest normal guard in the stages of the step.")
    feature: int = whole(_STEP, "Features at the start of the step, -1 if not watched.")
    choice_at_start: Floats = row(_STEP, 3, "N", "Null-space force chosen at the start of the step.")
    choice_at_end: Floats = row(_STEP, 3, "N", "Null-space force chosen at the end of the step.")
    is_in_problem: bool = question(_STEP, "The contact is grouped into an island.")

    # --- an event -----------------------------------------------------------------------------------------------------
    code_before: int = whole(_EVENT, "Bits of Eq. (29) before the event.")
    code_during: int = whole(_EVENT, "Bits of Eq. (29) during the impact.")
    was_averaged: bool = question(_EVENT, "Forces were averaged before the event.")
    event_impulse: Floats = row(_EVENT, 3, "N s", "Impulse of the event, n, t1, t2.")
    event_friction: Vector2 = vector(_EVENT, 2, "N s", "Tangential impulse of the event.", inside=("event_impulse", 1))
    prescribed_rate: Floats = row(_EVENT, 3, "m/s", "Part of the rates that driven bodies prescribe.")
    mode_agreed: Mode = one_of(Mode, _EVENT, "Mode that the contact problem found.")
    direction_agreed: Vector2 = vector(_EVENT, 2, "1", "Slip direction that the contact problem found.")
    has_no_force: bool = question(_EVENT, "Sliding has no contact force (Painleve).")
    release: Cause = one_of(Cause, _STATE, "Cause of its release by a jump of the contact point, else `NO_RELEASE`.")
    point_a_before_jump: Vector3 = vector(_EVENT, 3, "m", "Witness point on the first body before the jump.")
    point_b_before_jump: Vector3 = vector(_EVENT, 3, "m", "Witness point on the second body before the jump.")
    jump_a: Vector3 = vector(_EVENT, 3, "m", "Displacement of the first witness point in the jump.")
    jump_b: Vector3 = vector(_EVENT, 3, "m", "Displacement of the second witness point in the jump.")

    # --- an impact ----------------------------------------------------------------------------------------------------
    window_phase: Phase = one_of(Phase, _IMPACT, "Phase at the end of the last window.")
    window_sticks: bool = question(_IMPACT, "Friction held the contact at the end of the last window.")
    n_waves: int = whole(_IMPACT, "Number of waves of compression that passed.")
    layer: int = whole(_IMPACT, "Distance in contacts from those that act, -1 outside the window.")
    is_at_rim: bool = question(_IMPACT, "The contact is in the outermost layer of the window.")
    window_impulse: Floats = row(_IMPACT, 3, "N s", "Impulse of the windows so far, n, t1, t2.")
    window_stored: float = real(_IMPACT, "J", "Energy stored in the windows so far.")
    window_returned: float = real(_IMPACT, "J", "Energy returned in the windows so far.")
    window_dissipated: float = real(_IMPACT, "J", "Energy dissipated by friction in the windows so far.")
    window_deformation: float = real(_IMPACT, "m", "Deformation at the end of the last window.")
    window_energy: float = real(_IMPACT, "J", "Stored energy at the end of the last window.")
    window_lost: float = real(_IMPACT, "J", "Stored energy that is lost when the contact opens.")


def _declared(life: Life, is_of_row: bool) -> dict[str, Declaration]:
    """Numbers of a contact that outlive its place on the active list, of one life, by name."""
    return {
        name: one
        for name, one in declarations(ContactRecord).items()
        if one.life is life and one.is_of_row == is_of_row and not one.is_of_slot
    }


@final
class RowRecord(Record, key="rows", capacity="n_rows", length="model.n_rows", copies=_declared(_PARAMETER, True)):
    """A row: the declared contacts of two shapes, whose numbers follow one another.

    It also has the parameters that its contacts share. Inner states are those of its first contact.
    """

    first_contact: int = whole(_PARAMETER, "Number of its first declared contact.", has_end=True)
    end_contact: int = end_of("first_contact", "End of its declared contacts.")
    first_kind: int = whole(_PARAMETER, "Kind of its first contact; the kinds of the others follow.")
    inner_states: int
    pair: int
    rank: int = whole(_PARAMETER, "Number of rows before it with the same kinds.")


@final
class KindRecord(Record, key="kinds", capacity="n_kinds", length="model.n_kinds", copies=_declared(_PARAMETER, False)):
    """A kind of declared contacts: those with the same kinematics and the same laws.

    Offsets are those of the first contact of the kind. Contacts share parameters that nothing writes. Each has its own
    copy of a block that is written; the copies follow one another in the order of the rows.
    """

    features: int
    geometry_function: int
    geometry_stride: int = whole(_PARAMETER, "Floats from one copy of the block of the kinematics to the next, or 0.")
    law_stride: int = whole(_PARAMETER, "Floats from one copy of the block of the laws to the next, or 0.")


def _histories() -> dict[str, Declaration]:
    """States of a contact by name, with the life of a history: the making of the list."""
    return {name: replace(one, life=_STEP) for name, one in _declared(_STATE, False).items()}


if TYPE_CHECKING:
    HistoryRecord = ContactRecord
else:

    @final
    class HistoryRecord(Record, key="histories", capacity="n_slots", length="island.n_histories", copies=_histories()):
        """History of a contact while the list of active contacts is made: a contact that was listed, and is again.

        A contact that leaves the list loses its history. It is open, and starts afresh when it enters the list again.
        """

        declared: int = whole(Life.STEP, "Number of the declared contact.")


GEOMETRY_OFFSETS = "geometry_parameters", "features"
"""Offsets in the block of the kinematics of a contact."""
LAW_OFFSETS = (
    "normal_parameters",
    "friction_parameters",
    "anisotropy",
    "traction_parameters",
    "traction_out",
    "rates_parameters",
    "rates_out",
    "inner_states_at_start",
    "inner_states_copy",
    "impact_force_parameters",
    "efficiency_parameters",
    "map_parameters",
)
"""Offsets in the block of the laws of a contact."""
