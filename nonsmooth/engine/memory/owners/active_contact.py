"""Numbers of the contacts of one contact problem or impact."""

from __future__ import annotations

from typing import final

from nonsmooth.engine.memory.declare import Life, Record, Vector2, one_of, question, real, row, vector, whole
from nonsmooth.engine.memory.modes import Mode, Phase
from nonsmooth.engine.memory.sizes import per
from nonsmooth.types import Floats

_IMPACT, _SOLUTION = Life.IMPACT, Life.SOLUTION


@final
class ActiveContact(Record, key="actives", capacity="n_slots", length="problem.n_active"):
    """A contact of the group whose forces or impulses are found together."""

    contact: int = whole(_SOLUTION, "The contact.", inside=("problem.active", 0))

    # --- the contact problem ------------------------------------------------------------------------------------------
    friction_coefficient: float = real(_SOLUTION, "1", "Coefficient of friction at the slip velocity.")
    static_coefficient: float = real(_SOLUTION, "1", "Coefficient of static friction.")
    coefficient_kept: float = real(_SOLUTION, "1", "Coefficient of friction while the search changes it.")
    static_kept: float = real(_SOLUTION, "1", "Coefficient of static friction while the search changes it.")
    static_margin: float = real(_SOLUTION, "N", "Distance of the friction to its static bound.")
    mode_tried: Mode = one_of(Mode, _SOLUTION, "Mode that the search tries.")
    mode_past: Mode = one_of(Mode, _SOLUTION, "Mode of the last problem, where the search starts.")
    mode_found: Mode = one_of(Mode, _SOLUTION, "Mode of the best attempt.")
    mode_closed: Mode = one_of(Mode, _SOLUTION, "Mode while sliding contacts are tried with static friction.")
    is_normal_force_unknown: bool = question(_SOLUTION, "The normal force is an unknown.")
    sticks: bool = question(_SOLUTION, "Friction holds the contact: its two components are unknowns.")
    is_at_rest: bool = question(_SOLUTION, "The slip velocity is zero.")
    has_redundant_force: bool = question(_SOLUTION, "The force is not unique.")
    was_freed: bool = question(_SOLUTION, "The search has let the contact slide.")
    has_given_force: bool = question(_SOLUTION, "The normal force is given by a law.")
    given_force: float = real(_SOLUTION, "N", "The normal force that the law gives.")
    acceleration: Floats = row(_SOLUTION, 3, "m/s^2", "Acceleration, n, t1, t2.")
    normal_acceleration: float = real(_SOLUTION, "m/s^2", "Normal acceleration.", inside=("acceleration", 0))
    slip_acceleration: Vector2 = vector(_SOLUTION, 2, "m/s^2", "Slip acceleration.", inside=("acceleration", 1))
    gap_after: float = real(_SOLUTION, "m", "Gap after the time over which forces are averaged.")
    force: Floats = row(_SOLUTION, 3, "N", "Contact force, n, t1, t2.", inside=("problem.forces", 0))
    normal_force: float = real(_SOLUTION, "N", "Normal force.", inside=("problem.forces", 0))
    friction: Vector2 = vector(_SOLUTION, 2, "N", "Friction force.", inside=("problem.forces", 1))
    free: Floats = row(_SOLUTION, 3, "m/s^2", "Contact-free acceleration.", inside=("problem.free_accelerations", 0))
    rigid: Floats = row(_SOLUTION, 3, "1/kg", "Diagonal of its Delassus block, while the search changes it.")
    direction: Vector2 = vector(_SOLUTION, 2, "1", "Slip direction that the search tries.")
    direction_found: Vector2 = vector(_SOLUTION, 2, "1", "Slip direction of the best attempt.")
    direction_closed: Vector2 = vector(_SOLUTION, 2, "1", "Slip direction while static friction is tried.")

    # --- its rows of the matrices -------------------------------------------------------------------------------------
    first_unknown: int = whole(_SOLUTION, "First of its unknowns.", inside=("problem.first_unknown", 0))
    end_unknown: int = whole(_SOLUTION, "End of its unknowns.", inside=("problem.first_unknown", 1))
    first_block: int = whole(
        _SOLUTION, "First of its Delassus blocks.", inside=("island.block_start", 0), behind="problem.first_grouped"
    )
    end_block: int = whole(
        _SOLUTION, "End of its Delassus blocks.", inside=("island.block_start", 1), behind="problem.first_grouped"
    )
    diagonal_block: int = whole(Life.DERIVED, "Its Delassus block on the diagonal.", behind="problem.first_grouped")
    n_blocks: int = whole(_SOLUTION, "Number of contacts that it acts on.")
    block_mark: int = whole(_SOLUTION, "Contact that has counted it last.")
    rank: int = whole(_SOLUTION, "Its position in the order with a small band, or -1.")

    # --- an impact ----------------------------------------------------------------------------------------------------
    phase: Phase = one_of(Phase, _IMPACT, "Phase of the impact.")
    was_halted: bool = question(_IMPACT, "Friction has stopped its slip within the step.")
    is_lossless: bool = question(_IMPACT, "Its restitution is 1, whatever its law.")
    rest_slip: float = real(_IMPACT, "m/s", "Slip that counts as rest.")
    impulse_scale: float = real(_IMPACT, "N s", "Impulse that stops its approach.")
    energy_stored: float = real(_IMPACT, "J", "Energy stored in compressions.")
    energy_returned: float = real(_IMPACT, "J", "Energy returned in expansions.")
    energy_dissipated: float = real(_IMPACT, "J", "Energy dissipated by friction.")
    impulse: Floats = row(_IMPACT, 3, "N s", "Impulse, n, t1, t2.", inside=("impact.impulse", 0))
    rate: Floats = row(_IMPACT, 3, "m/s", "Gap rate and slip velocity.", inside=("impact.rates", 0))
    gap_rate: float = real(_IMPACT, "m/s", "Gap rate.", inside=("impact.rates", 0))
    slip: Vector2 = vector(_IMPACT, 2, "m/s", "Slip velocity.", inside=("impact.rates", 1))
    rate_before: Floats = row(_IMPACT, 3, "m/s", "Gap rate and slip before impact.", inside=("impact.rates_before", 0))
    gap_rate_before: float = real(_IMPACT, "m/s", "Gap rate before the impact.", inside=("impact.rates_before", 0))
    slip_before: Vector2 = vector(_IMPACT, 2, "m/s", "Slip velocity before impact.", inside=("impact.rates_before", 1))
    deformation_scale: float = real(_IMPACT, "m", "Scale of the deformation.")
    force_scale: float = real(_IMPACT, "N", "Scale of the force.")
    energy_scale: float = real(_IMPACT, "J", "Scale of the energy.")
    work_accounted: float = real(_IMPACT, "J", "Work of the normal force that is accounted for.")
    phase_kept: Phase = one_of(Phase, _IMPACT, "Phase before a contact became the clock.")
    sticking_kept: bool = question(_IMPACT, "Friction held it before a contact became the clock.")
    stored_kept: float = real(_IMPACT, "J", "Energy stored before a contact became the clock.")
    returned_kept: float = real(_IMPACT, "J", "Energy returned before a contact became the clock.")
    accounted_kept: float = real(_IMPACT, "J", "Work accounted for before a contact became the clock.")
    direction_kept: Vector2 = vector(_IMPACT, 2, "1", "Slip direction before a contact became the clock.")


@final
class Unknown(Record, key="unknowns", capacity=per(3, "n_slots"), length="problem.n_unknown"):
    """An unknown of the contact problem."""

    contact: int = whole(_SOLUTION, "Active contact.")
    direction: int = whole(_SOLUTION, "Component of the force: 0 for n, 1 for t1, 2 for t2.")
    is_turn: bool = question(_SOLUTION, "It is the turn of a slip direction, not a force.")
