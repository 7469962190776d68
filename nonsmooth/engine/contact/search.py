"""The search for modes and forces by one solver.

Each solver finds forces for Coulomb's law with one coefficient per contact, and only to its tolerance. The search does
all the rest, in the same way for all solvers:

1. A contact at rest gets its static coefficient, so that it sticks if it can. If it is found to slide, the search runs
   again, with its kinetic coefficient and without sticking.
2. The solver improves the forces stage by stage. After each stage, modes are guessed from the forces.
3. Slip directions are made exact (:mod:`nonsmooth.engine.contact.slip_directions`).
4. The modes are verified by exact forces (:mod:`nonsmooth.engine.contact.trial`).

A solver reads G, ``free``, ``is_at_rest``, ``friction_coefficient`` and, for sliding contacts, ``direction``. It writes
the forces, and returns True if a further stage would not change them.

Redundant forces need more care. A solver may put the friction of one contact on its bound and leave others below it, so
that sliding is guessed although nothing moves. Forces of least norm may be tensile although others are not. Each of the
steps below that deals with such a case says so.
"""

from __future__ import annotations

from nonsmooth.engine.contact import gauss_seidel, lemke, newton
from nonsmooth.engine.contact.enumeration import enumerate_modes
from nonsmooth.engine.contact.gauss_seidel import search_by_sweeps
from nonsmooth.engine.contact.lemke import search_by_pivots
from nonsmooth.engine.contact.newton import search_by_newton
from nonsmooth.engine.contact.slip_directions import find_slip_directions
from nonsmooth.engine.contact.trial import EQUAL, check_laws, evaluate_accelerations, guess_modes_from_forces, verify
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.memory.solvers import Solver
from nonsmooth.engine.native.kernel import ActiveContact, Workspace, entry_point, kernel
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.arrays import clear, copy_numbers
from nonsmooth.engine.numerics.vectors import length, unit

_MOST_EFFORT = 3e8
"""Maximum effort of one problem, in cubes of the number of unknowns summed over all trials. It takes about a second."""
_EQUALLY_TENSILE = 1e-6
"""Relative difference of tensile forces below which contacts open together. Symmetric contacts differ by round-off."""


# --- the search -------------------------------------------------------------------------------------------------------


@entry_point("b1(ws, Solver)")
def find_modes(ws: Workspace, solver: Solver) -> bool:
    """Find modes and forces of the active contacts by one solver. True if they are found, and fulfil the laws.

    ``mode_past`` holds the past modes. Contacts that have just started to slide must not stick again at the static
    coefficient, so the first search excludes this. Of several solutions, one with more sticking and closed contacts is
    preferred.
    """
    # enumeration needs no exclusions: it tries all modes
    has_found = enumerate_modes(ws, first=0) > 0 if solver == Solver.ENUMERATION else _find_by_solver(ws, solver)
    if has_found:
        _prefer_sticking(ws)
        _prefer_closed(ws)
    return has_found


@kernel("b1(ws, Solver)")
def _find_by_solver(ws: Workspace, solver: Solver) -> bool:
    """Search with the contacts that have just started to slide kept from sticking, and if that fails, without this.

    They are at rest, and their past mode is sliding. ``was_freed`` marks the contacts that must not stick: they have
    the kinetic coefficient. True if a solution is found.
    """
    has_sliding = False
    for active in ws.actives:
        active.was_freed = active.is_at_rest and active.mode_past == Mode.SLIDE
        has_sliding = has_sliding or active.was_freed
    if has_sliding:
        if _search(ws, solver):
            return True
        for active in ws.actives:
            active.was_freed = False
    return _search(ws, solver)


@kernel("b1(ws, Solver)")
def _search(ws: Workspace, solver: Solver) -> bool:
    """Search in rounds. After each, contacts found to slide are kept from sticking. True if a solution is found.

    So a contact that exceeds its static bound gets its kinetic coefficient in the next round. False if a round frees no
    contact whose coefficients differ: the next round would be the same.
    """
    # each round but the last frees a contact
    for _ in range(1 + ws.problem.n_active):
        if _search_round(ws, solver):
            return True
        if not _exclude_sticking(ws):
            return False
    return False


@kernel("b1(ws, Solver)")
def _search_round(ws: Workspace, solver: Solver) -> bool:
    """Search by the stages of a solver. True if a solution is found. Interrupts and too much effort end the search.

    If False, ``mode_found`` holds the last guess, from which the next round frees contacts.
    """
    n_stages = _n_stages(solver)
    # the forces of the first stage start at zero
    clear(ws.floats, ws.problem.forces_at_start.start, 3 * ws.problem.n_active)
    for stage in range(n_stages):
        if ws.problem.effort >= _MOST_EFFORT or interrupted(ws, ws.problem.n_active):
            return False
        has_settled = _guess_by_stage(ws, solver, stage)
        # the modes of a contact at its static bound are known only when the forces have settled
        if not has_settled and stage < n_stages - 1 and _may_still_stick(ws):
            continue
        _store_modes(ws)
        if _verify_guess(ws):
            return True
        # the verification has changed modes and directions
        _restore_modes(ws)
        # further stages would lead to the same guess
        if has_settled:
            return False
    return False


@kernel("i8(Solver)")
def _n_stages(solver: Solver) -> int:
    """Number of stages of a solver. Each starts from the forces and directions that the one before has found."""
    # enumeration has no stages
    if solver == Solver.GAUSS_SEIDEL:
        return gauss_seidel.STAGES
    return lemke.STAGES if solver == Solver.LEMKE else newton.STAGES


@kernel("b1(ws, Solver, i8)")
def _guess_by_stage(ws: Workspace, solver: Solver, stage: int) -> bool:
    """Improve the forces by a stage of a solver, and guess modes from them. True if a further stage is useless.

    The forces have settled then, or the solver has failed. They go from stage to stage in ``forces_at_start``, because
    trials overwrite the others.
    """
    n, forces, kept = 3 * ws.problem.n_active, ws.problem.forces.start, ws.problem.forces_at_start.start
    copy_numbers(ws.floats, kept, n, forces)
    # solvers know one coefficient of friction per contact
    _unite_coefficients(ws)
    has_settled = _improve_forces(ws, solver, stage)
    copy_numbers(ws.floats, forces, n, kept)
    guess_modes_from_forces(ws)
    _restore_coefficients(ws)
    return has_settled


@kernel("b1(ws, Solver, i8)")
def _improve_forces(ws: Workspace, solver: Solver, stage: int) -> bool:
    """Run a ``stage`` of a solver, counted from 0. True if a further stage would not change the forces."""
    # enumeration has no stages: the last solver is Newton's method
    if solver == Solver.GAUSS_SEIDEL:
        return search_by_sweeps(ws, stage)
    if solver == Solver.LEMKE:
        return search_by_pivots(ws, stage)
    return search_by_newton(ws, stage)


@kernel()
def _unite_coefficients(ws: Workspace) -> None:
    """Give each contact at rest one coefficient of friction: the static one, or the kinetic one if it may not stick.

    Solvers know one coefficient only. :func:`_restore_coefficients` brings both back.
    """
    for active in ws.actives:
        active.coefficient_kept, active.static_kept = active.friction_coefficient, active.static_coefficient
        if active.is_at_rest:
            if active.was_freed:
                active.static_coefficient = active.friction_coefficient
            else:
                active.friction_coefficient = active.static_coefficient


@kernel()
def _restore_coefficients(ws: Workspace) -> None:
    """Restore the coefficients that :func:`_unite_coefficients` has changed."""
    for active in ws.actives:
        active.friction_coefficient, active.static_coefficient = active.coefficient_kept, active.static_kept


@kernel("b1(ActiveContact)")
def _has_two_bounds(active: ActiveContact) -> bool:
    """True if the static coefficient of a contact differs from the kinetic one."""
    return active.static_coefficient != active.friction_coefficient


@kernel("b1(ws)")
def _may_still_stick(ws: Workspace) -> bool:
    """True if a contact is guessed to slide at its static bound, where forces that settle may still let it stick."""
    for active in ws.actives:
        # with one coefficient, sticking and sliding have the same bound
        may_stick = active.is_at_rest and not active.was_freed and _has_two_bounds(active)
        if may_stick and active.mode_tried == Mode.SLIDE:
            return True
    return False


@kernel("b1(ws)")
def _exclude_sticking(ws: Workspace) -> bool:
    """Keep the contacts at rest that were found to slide from sticking. True if a new search would differ.

    It differs if the kinetic coefficient of such a contact is not the static one.
    """
    has_changed = False
    for active in ws.actives:
        if active.is_at_rest and active.mode_found == Mode.SLIDE and not active.was_freed:
            active.was_freed = True
            has_changed = has_changed or _has_two_bounds(active)
    return has_changed


# --- the verification of a guess --------------------------------------------------------------------------------------


@kernel("b1(ws)")
def _verify_guess(ws: Workspace) -> bool:
    """Verify the guessed modes in several forms. True if one fulfils the laws: it is then the solution."""
    # the modes that the accelerations show, then the guess itself, then the guess with the forces of the solver
    if _verify_by_acceleration(ws) or _verify_or_open(ws):
        return True
    return ws.problem.is_deficient and _verify_forces_of_solver(ws)


@kernel("b1(ws)")
def _verify_by_acceleration(ws: Workspace) -> bool:
    """Verify the modes that the accelerations show, if they differ from the guess. True if they fulfil the laws.

    A contact with friction on its bound but without slip acceleration sticks. Solvers produce such contacts if forces
    are redundant. If the laws are violated, the guess is restored.
    """
    evaluate_accelerations(ws)
    if not _guess_modes_from_accelerations(ws):
        return False
    if _verify_or_open(ws):
        return True
    _restore_guess(ws)
    return False


@kernel("b1(ws)")
def _guess_modes_from_accelerations(ws: Workspace) -> bool:
    """Set the modes that the accelerations show, except where the mode is the past one. True if a mode changes.

    A contact that does not separate is closed. At rest, it sticks if it has no slip acceleration.
    """
    has_changed = False
    # redundant contacts may disagree by more than round-off
    small = EQUAL * ws.problem.small_acceleration
    for active in ws.actives:
        # modes of the past are kept, to continue it; the mode of a contact that separates is, too
        separates = active.mode_tried == Mode.OPEN if active.has_given_force else active.normal_acceleration > small
        if active.mode_tried == active.mode_past or separates:
            continue
        is_still = active.is_at_rest and length(active.slip_acceleration) <= small
        mode = Mode.STICK if is_still else Mode.SLIDE
        if mode != active.mode_tried:
            has_changed = True
            active.mode_tried = mode
            if active.is_at_rest and mode == Mode.SLIDE:
                active.direction = unit(active.slip_acceleration)
    return has_changed


@kernel("b1(ws)")
def _verify_or_open(ws: Workspace) -> bool:
    """Verify the modes under trial, and open contacts in steps if redundant forces are tensile.

    True if the laws are fulfilled. If this fails, the modes are verified once more, leniently: tensile forces of least
    norm may then be replaced by compressive ones of the same motion. Directions of slips that begin are made exact.
    """
    find_slip_directions(ws)
    for active in ws.actives:
        # stored for the last, lenient attempt
        active.mode_closed, active.direction_closed = active.mode_tried, active.direction
    if verify(ws, is_lenient=False):
        return True
    # unique forces that violate a law cannot be replaced
    if not ws.problem.is_deficient:
        return False
    # TODO: a single contact that must open is found only if it is the most tensile one at some step
    while ws.problem.effort < _MOST_EFFORT and _open_most_tensile(ws):
        find_slip_directions(ws)
        if verify(ws, is_lenient=False):
            return True
    # the contacts that were opened may carry a load that the others cannot
    for active in ws.actives:
        active.mode_tried, active.direction = active.mode_closed, active.direction_closed
    return verify(ws, is_lenient=True)


@kernel("b1(ws)")
def _open_most_tensile(ws: Workspace) -> bool:
    """Open the closed contacts with the largest tensile forces. True if there are any, False if no force is tensile."""
    # a tensile force below this threshold is round-off
    worst = -ws.problem.small_force
    for active in ws.actives:
        if active.mode_tried != Mode.OPEN:
            worst = min(worst, active.normal_force)
    has_opened = False
    for active in ws.actives:
        # tensile forces are negative; equally tensile ones open together, as symmetric contacts differ by round-off
        is_tensile = active.normal_force < -ws.problem.small_force
        if active.mode_tried != Mode.OPEN and is_tensile and active.normal_force <= (1.0 - _EQUALLY_TENSILE) * worst:
            active.mode_tried = Mode.OPEN
            has_opened = True
    return has_opened


@kernel("b1(ws)")
def _verify_forces_of_solver(ws: Workspace) -> bool:
    """Take the forces of the solver as they are, and count them as unique. True if they fulfil the laws.

    If sliding contacts are redundant, the motion depends on the distribution of their load, and the forces of least
    norm may violate the laws.
    """
    _restore_guess(ws)
    # with unique forces, the laws are checked without a new distribution
    for active in ws.actives:
        active.has_redundant_force = False
    ws.problem.is_deficient = False
    return check_laws(ws, is_lenient=False) and _friction_opposes_slip(ws)


@kernel("b1(ws)")
def _friction_opposes_slip(ws: Workspace) -> bool:
    """True if the friction of all sliding contacts is -mu f_n d. Forces of a solver fulfil it to its tolerance only."""
    small = ws.problem.small_force
    for active in ws.actives:
        along = active.friction_coefficient * active.normal_force
        if active.mode_tried != Mode.SLIDE:
            continue
        (t1, t2), (d1, d2) = active.friction, active.direction
        # a force that is not finite counts as a violation
        if not (abs(t1 + along * d1) <= small and abs(t2 + along * d2) <= small):
            return False
    return True


@kernel()
def _store_modes(ws: Workspace) -> None:
    """Store the modes and slip directions under trial, so that further trials may change them."""
    for active in ws.actives:
        active.mode_found, active.direction_found = active.mode_tried, active.direction


@kernel()
def _restore_modes(ws: Workspace) -> None:
    """Restore the modes and slip directions of :func:`_store_modes`."""
    for active in ws.actives:
        active.mode_tried, active.direction = active.mode_found, active.direction_found


@kernel()
def _restore_guess(ws: Workspace) -> None:
    """Restore the modes and slip directions of :func:`_store_modes`, and the forces in ``forces_at_start``."""
    _restore_modes(ws)
    copy_numbers(ws.floats, ws.problem.forces_at_start.start, 3 * ws.problem.n_active, ws.problem.forces.start)


# --- the choice between several solutions -----------------------------------------------------------------------------


@kernel()
def _store_solution(ws: Workspace) -> None:
    """Store modes, slip directions and forces of the solution, for :func:`_restore_guess`."""
    _store_modes(ws)
    copy_numbers(ws.floats, ws.problem.forces.start, 3 * ws.problem.n_active, ws.problem.forces_at_start.start)


@kernel()
def _keep_if_lawful(ws: Workspace) -> None:
    """Keep the modes under trial if they fulfil the laws. Otherwise restore the solution of :func:`_store_solution`."""
    if not _verify_or_open(ws):
        _restore_guess(ws)
        # the trial has overwritten them, and the choice between solutions reads them
        evaluate_accelerations(ws)


@kernel()
def _prefer_closed(ws: Workspace) -> None:
    """Replace the solution by one in which all contacts that do not separate are closed, if that fulfils the laws."""
    # of several solutions, one with more closed contacts is preferred
    _store_solution(ws)
    if _guess_modes_from_accelerations(ws):
        _keep_if_lawful(ws)


@kernel()
def _prefer_sticking(ws: Workspace) -> None:
    """Replace the solution by one in which contacts at rest stick, if that fulfils the laws.

    With friction between the kinetic and the static bound, a contact at rest may stick or slide. It sticks, unless it
    was sliding before.
    """
    _store_solution(ws)
    has_changed = False
    for active in ws.actives:
        may_stick = active.is_at_rest and active.mode_past != Mode.SLIDE and _has_two_bounds(active)
        if may_stick and active.mode_tried == Mode.SLIDE:
            active.mode_tried = Mode.STICK
            has_changed = True
    if has_changed:
        _keep_if_lawful(ws)
