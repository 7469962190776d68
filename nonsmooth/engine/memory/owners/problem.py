"""Numbers of one contact problem."""

from __future__ import annotations

from typing import final

from nonsmooth.engine.memory.declare import FloatRow, IntegerRow, Life, Part, array, question, real, whole
from nonsmooth.engine.memory.sizes import ends, fixed, lemke_columns, lemke_numbers, matrix_entries, per

_SOLUTION = Life.SOLUTION


@final
class Problem(Part, key="problem"):
    """Numbers of the contact problem of one group of contacts."""

    n_active: int = whole(_SOLUTION, "Number of contacts of the problem.")
    first_grouped: int = whole(_SOLUTION, "Where they begin among the grouped contacts.")
    active: IntegerRow = array(_SOLUTION, per(1, "n_slots"), int, "", "Contacts of the problem.")
    order: IntegerRow = array(_SOLUTION, per(1, "n_slots"), int, "", "Order of the contacts with a small band.")
    link_next: IntegerRow = array(
        _SOLUTION, per(2, "n_slots"), int, "", "Next entry of the list of contacts of an articulation."
    )
    half_band: int = whole(_SOLUTION, "Half width of the band of the matrix.")
    null_half_band: int = whole(_SOLUTION, "Half width of the band of its square.")
    null_shift: float = real(_SOLUTION, "", "Shift of the diagonal of the square.")
    n_unknown: int = whole(_SOLUTION, "Number of unknowns.")
    first_unknown: IntegerRow = array(_SOLUTION, ends("n_slots"), int, "", "First unknown of each active contact.")
    is_deficient: bool = question(_SOLUTION, "The matrix is rank-deficient: forces are not unique.")
    rank: int = whole(_SOLUTION, "Rank of the matrix.")
    is_null_space_banded: bool = question(_SOLUTION, "The null space is known by the band of the square.")
    guess: int = whole(_SOLUTION, "Where the first guess of the accelerations is, or 0.")
    is_unsettled: bool = question(_SOLUTION, "The slip at the end of an implicit stage has not converged.")
    stage_time: float = real(_SOLUTION, "s", "Time of the implicit stage at whose end the slip is found, or 0.")
    effort: float = real(_SOLUTION, "1", "Operations of the search so far.")
    acceleration_scale: float = real(_SOLUTION, "m/s^2", "Largest acceleration of the problem.")
    small_acceleration: float = real(_SOLUTION, "m/s^2", "Acceleration that counts as zero.")
    small_force: float = real(_SOLUTION, "N", "Force that counts as zero.")
    motion: FloatRow = array(
        _SOLUTION, fixed(5), float, "m/s, 1/s", "Slip velocity and relative spin that a traction law is given."
    )
    forces: FloatRow = array(_SOLUTION, per(3, "n_slots"), float, "N", "Forces of the active contacts.")
    forces_at_start: FloatRow = array(_SOLUTION, per(3, "n_slots"), float, "N", "Forces at the start of the search.")
    forces_kept: FloatRow = array(_SOLUTION, per(3, "n_slots"), float, "N", "Forces of the last iteration.")
    free_accelerations: FloatRow = array(
        _SOLUTION, per(3, "n_slots"), float, "m/s^2", "Accelerations without contact forces."
    )
    right: FloatRow = array(_SOLUTION, per(3, "n_slots"), float, "m/s^2", "Right-hand side of the unknowns.")
    x: FloatRow = array(_SOLUTION, per(3, "n_slots"), float, "N", "Unknowns.")
    sigma: FloatRow = array(_SOLUTION, per(6, "n_slots"), float, "", "Work array of the null space.")
    matrix: FloatRow = array(_SOLUTION, matrix_entries, float, "", "Matrix of the unknowns, factorised.", is_late=True)
    reduced: FloatRow = array(_SOLUTION, matrix_entries, float, "", "Matrix of the unknowns.", is_late=True)
    basis: FloatRow = array(
        _SOLUTION,
        matrix_entries,
        float,
        "",
        "Basis of the null space, or the square of the matrix in a band.",
        is_late=True,
    )
    null: FloatRow = array(
        _SOLUTION,
        matrix_entries,
        float,
        "",
        "Projection onto the null space, or the factor of the square.",
        is_late=True,
    )
    tableau: FloatRow = array(_SOLUTION, lemke_numbers, float, "", "Tableau of Lemke's method.", is_late=True)
    lemke_contact: IntegerRow = array(_SOLUTION, per(6, "n_pivoted"), int, "", "Active contact of each variable.")
    lemke_corner: IntegerRow = array(
        _SOLUTION, per(6, "n_pivoted"), int, "", "Edge of the friction pyramid of each variable."
    )
    lemke_row: IntegerRow = array(_SOLUTION, per(6, "n_pivoted"), int, "", "Variable of each row.")
    lemke_column: IntegerRow = array(_SOLUTION, lemke_columns, int, "", "Variable of each column.")
    simplex: FloatRow = array(
        _SOLUTION, fixed(16), float, "m", "Simplex of the search for the separation of a pair.", is_late=True
    )
