"""Workspace of one instant: of its event, its impact and its contact problem."""

from __future__ import annotations

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
from nonsmooth.engine.memory.layout import IMPACT_STATE, MOST_FACES, MOST_POINTS, N_STAGES
from nonsmooth.engine.memory.modes import Truncation
from nonsmooth.engine.memory.sizes import (
    ends,
    fixed,
    impulse_numbers,
    lemke_columns,
    lemke_numbers,
    map_numbers,
    matrix_entries,
    per,
)

_EVENT = Life.EVENT


@final
class Event(Singleton, key="event"):
    """Numbers of the event that is being processed, such as its energies; they are recorded with the event."""

    n_recorded: int = whole(_EVENT, "Number of records of the instant so far.")
    n_phases: int = whole(_EVENT, "Number of phases of the impact.")
    truncation: Truncation = one_of(Truncation, _EVENT, "How the impact ended if it was cut short.")
    slow_speed: float = real(_EVENT, "m/s", "Approach below which bounces are shorter than their contact time.")
    head: FloatRow = floats(_EVENT, fixed(5), "", "Time of the event and its energies.")
    u_before: FloatRow = floats(_EVENT, per(1, "n_u"), "", "Velocities before the event.")
    listed: IntegerRow = integers(_EVENT, per(1, "n_slots"), "Contacts that are recorded with the event.")


_IMPACT = Life.IMPACT


@final
class Impact(Singleton, key="impact"):
    """Workspace of the impact that is being solved.

    A large impact is solved in windows, each with a part of the contacts (:mod:`nonsmooth.engine.impact.window`). The
    active contacts are then the contacts of the current window. ``n_colliding``, ``colliding``, ``chain`` and ``u``
    belong to the whole impact.
    """

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


_SOLUTION = Life.SOLUTION
_REUSED = Life.REUSED


@final
class Problem(Singleton, key="problem"):
    """Workspace of the contact problem of one group of contacts: the search for their forces."""

    n_active: int = whole(_SOLUTION, "Number of contacts of the problem.")
    first_grouped: int = whole(_SOLUTION, "Where they begin among the grouped contacts.")
    active: IntegerRow = integers(_SOLUTION, per(1, "n_slots"), "Contacts of the problem.")
    order: IntegerRow = integers(_SOLUTION, per(1, "n_slots"), "Order of the contacts with a small band.")
    link_next: IntegerRow = integers(_SOLUTION, per(2, "n_slots"), "Next entry in an articulation's list of contacts.")
    half_band: int = whole(_SOLUTION, "Half width of the band of the matrix.")
    null_half_band: int = whole(_SOLUTION, "Half width of the band of its square.")
    null_shift: float = real(_SOLUTION, "", "Shift of the diagonal of the square.")
    n_unknown: int = whole(_SOLUTION, "Number of unknowns.")
    first_unknown: IntegerRow = integers(_SOLUTION, ends("n_slots"), "First unknown of each active contact.")
    is_deficient: bool = question(_SOLUTION, "The matrix is rank-deficient: forces are not unique.")
    rank: int = whole(_SOLUTION, "Rank of the matrix.")
    is_null_space_banded: bool = question(_SOLUTION, "The null space is known by the band of the square.")
    guess: int = whole(_SOLUTION, "Where the first guess of the accelerations is, or 0.")
    is_unsettled: bool = question(_SOLUTION, "The slip at the end of an implicit stage has not converged.")
    stage_time: float = real(_REUSED, "s", "Time of the implicit stage at whose end the slip is found, or 0.")
    effort: float = real(_SOLUTION, "1", "Operations of the search so far.")
    acceleration_scale: float = real(_SOLUTION, "m/s^2", "Largest acceleration of the problem.")
    small_acceleration: float = real(_SOLUTION, "m/s^2", "Acceleration that counts as zero.")
    small_force: float = real(_SOLUTION, "N", "Force that counts as zero.")
    motion: FloatRow = floats(_SOLUTION, fixed(5), "m/s, 1/s", "Slip velocity and relative spin for a traction law.")
    forces: FloatRow = floats(_SOLUTION, per(3, "n_slots"), "N", "Forces of the active contacts.")
    forces_at_start: FloatRow = floats(_SOLUTION, per(3, "n_slots"), "N", "Forces at the start of the search.")
    forces_kept: FloatRow = floats(_SOLUTION, per(3, "n_slots"), "N", "Forces of the last iteration.")
    free_accelerations: FloatRow = floats(_SOLUTION, per(3, "n_slots"), "m/s^2", "Contact-free accelerations.")
    right: FloatRow = floats(_SOLUTION, per(3, "n_slots"), "m/s^2", "Right-hand side of the unknowns.")
    x: FloatRow = floats(_SOLUTION, per(3, "n_slots"), "N", "Unknowns.")
    sigma: FloatRow = floats(_SOLUTION, per(6, "n_slots"), "", "Work array of the null space.")
    matrix: FloatRow = floats(_SOLUTION, matrix_entries, "", "Matrix of the unknowns, factorised.", is_late=True)
    reduced: FloatRow = floats(_SOLUTION, matrix_entries, "", "Matrix of the unknowns.", is_late=True)
    basis: FloatRow = floats(
        _SOLUTION, matrix_entries, "", "Basis of the null space, or the square of the matrix in a band.", is_late=True
    )
    null: FloatRow = floats(
        _SOLUTION, matrix_entries, "", "Projection onto the null space, or the factor of the square.", is_late=True
    )
    tableau: FloatRow = floats(_SOLUTION, lemke_numbers, "", "Tableau of Lemke's method.", is_late=True)
    lemke_contact: IntegerRow = integers(_SOLUTION, per(6, "n_pivoted"), "Active contact of each variable.")
    lemke_corner: IntegerRow = integers(_SOLUTION, per(6, "n_pivoted"), "Friction pyramid's edge of each variable.")
    lemke_row: IntegerRow = integers(_SOLUTION, per(6, "n_pivoted"), "Variable of each row.")
    lemke_column: IntegerRow = integers(_SOLUTION, lemke_columns, "Variable of each column.")
    simplex: FloatRow = floats(_SOLUTION, fixed(28), "m", "Simplex in search of a pair's separation.", is_late=True)
    polytope: FloatRow = floats(
        _SOLUTION, fixed(3 * MOST_POINTS), "m", "Points of the polytope in proof of a pair's depth.", is_late=True
    )
    faces: FloatRow = floats(
        _SOLUTION, fixed(4 * MOST_FACES), "", "Heights and outward normals of the faces of the polytope.", is_late=True
    )
    face_points: IntegerRow = integers(
        _SOLUTION, fixed(3 * MOST_FACES), "Points of the faces of the polytope.", is_late=True
    )
    rim: IntegerRow = integers(
        _SOLUTION, fixed(2 * MOST_FACES), "Edges around the faces that a new point of the polytope sees.", is_late=True
    )
