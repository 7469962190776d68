"""A search for modes and forces by one solver, with the static and the kinetic bound told apart.

The contract of a solver: it reads G, ``free_accelerations``, who is ``at_rest``, the coefficients ``mu`` and, of
sliding contacts, ``active_directions``; it improves the ``active_forces`` stage by stage and returns 1 where a further
stage would not help.  Every contact at rest has one cone, that of ``mu``.  Which modes the forces mean, and whether
these are right, is found here alike for all.
"""

from __future__ import annotations

from nonsmooth.engine.contact import gauss_seidel, lemke, newton
from nonsmooth.engine.contact.enumeration import enumerate_modes
from nonsmooth.engine.contact.gauss_seidel import search_by_sweeps
from nonsmooth.engine.contact.lemke import search_by_pivots
from nonsmooth.engine.contact.newton import search_by_newton
from nonsmooth.engine.contact.polish import polish
from nonsmooth.engine.contact.trial import EQUAL, fulfils_laws, guess_modes_from_forces, set_scales, verify
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.memory.solvers import ENUMERATION, GAUSS_SEIDEL, LEMKE
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.vectors import length

_MOST_EFFORT = 3e8
"""What the trials of one problem may cost, each counting as the cube of its unknowns: about a second."""
_SAME = 1e-6
"""Contacts that pull alike, but for this part, open together."""


@kernel("b1(ws, i8, i8)")
def _improve(ws: Workspace, solver: int, stage: int) -> bool:
    if solver == GAUSS_SEIDEL:
        return search_by_sweeps(ws, stage)
    if solver == LEMKE:
        return search_by_pivots(ws, stage)
    return search_by_newton(ws, stage)


@kernel()
def _write_cones(ws: Workspace) -> None:
    """Give every contact at rest one cone: the static one, or the kinetic one where it may not stick."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.coefficient_kept, active.static_kept = active.friction_coefficient, active.static_coefficient
        if active.is_at_rest:
            if active.was_freed:
                active.static_coefficient = active.friction_coefficient
            else:
                active.friction_coefficient = active.static_coefficient


@kernel()
def _restore_cones(ws: Workspace) -> None:
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.friction_coefficient, active.static_coefficient = active.coefficient_kept, active.static_kept


@kernel("b1(ws)")
def _guess_by_motion(ws: Workspace) -> bool:
    """Try the modes that the accelerations tell, but for those of the past; return 1 if they differ."""
    differ = False
    small = EQUAL * ws.problem.small_acceleration
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.mode_tried == active.mode_past or active.normal_acceleration > small:
            continue
        mode = Mode.SLIDE
        a1, a2 = active.slip_acceleration
        slip = length(active.slip_acceleration)
        if active.is_at_rest and slip <= small:
            mode = Mode.STICK
        if mode != active.mode_tried:
            differ = True
            active.mode_tried = mode
            if active.is_at_rest and mode == Mode.SLIDE:
                active.direction = a1 / slip, a2 / slip
    return differ


@kernel()
def _keep_found(ws: Workspace) -> None:
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.mode_found = active.mode_tried
        active.direction_found = active.direction


@kernel()
def _take_found(ws: Workspace) -> None:
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.mode_tried = active.mode_found
        active.direction = active.direction_found


@kernel("i8(ws)")
def _open_pulling(ws: Workspace) -> int:
    """Open the closed contacts that pull most; return how many."""
    worst = -ws.problem.small_force
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.mode_tried != Mode.OPEN:
            worst = min(worst, active.normal_force)
    opened = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        pulls = active.normal_force <= (1.0 - _SAME) * worst and active.normal_force < -ws.problem.small_force
        if active.mode_tried != Mode.OPEN and pulls:
            active.mode_tried = Mode.OPEN
            opened += 1
    return opened


@kernel("b1(ws)")
def _accept(ws: Workspace) -> bool:
    """Verify the modes under trial; where the forces of least norm pull, open who pulls; return 1 if all is well."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.mode_closed = active.mode_tried
        active.direction_closed = active.direction
    if verify(ws, is_lenient=False):
        return True
    if not ws.problem.is_deficient:
        return False
    while ws.problem.effort < _MOST_EFFORT and _open_pulling(ws) > 0:
        polish(ws)
        if verify(ws, is_lenient=False):
            return True
    # without the share of those opened the others may not hold: forces that press, though not of least norm
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.mode_tried = active.mode_closed
        active.direction = active.direction_closed
    return verify(ws, is_lenient=True)


@kernel("b1(ws)")
def _rubs(ws: Workspace) -> bool:
    """Return 1 if all that slides has the friction of slip."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        pull = active.friction_coefficient * active.normal_force
        if active.mode_tried != Mode.SLIDE:
            continue
        (t1, t2), (d1, d2) = active.friction, active.direction
        if not (abs(t1 + pull * d1) <= ws.problem.small_force and abs(t2 + pull * d2) <= ws.problem.small_force):
            return False
    return True


@kernel("b1(ws)")
def _hasty(ws: Workspace) -> bool:
    """Return 1 if a contact seems to slide that, once the forces have settled, its static bound may still hold."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        held = active.is_at_rest and not active.was_freed and active.static_coefficient != active.friction_coefficient
        if held and active.mode_tried == Mode.SLIDE:
            return True
    return False


@kernel()
def _take_raw(ws: Workspace) -> None:
    """Go back to the forces of the solver, its modes and directions."""
    _take_found(ws)
    for i in range(3 * ws.problem.n_active):
        ws.problem.forces[i] = ws.problem.forces_at_start[i]


@kernel("b1(ws)")
def _try_by_motion(ws: Workspace) -> bool:
    """Let stick who seems to slide without acceleration, its friction being on the bound by chance; return 1 if right.

    Where forces are not unique a solver may well put the friction of some on the bound and let others do with less.
    """
    set_scales(ws)
    if _guess_by_motion(ws):
        polish(ws)
        if _accept(ws):
            return True
        _take_raw(ws)
    return False


@kernel("b1(ws)")
def _accept_raw(ws: Workspace) -> bool:
    """Take the forces of the solver as they are; return 1 if they are lawful.

    Where sliding contacts share their load at will, the motion hangs on the share, and least norm need not be lawful.
    """
    _take_raw(ws)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        active.has_redundant_force = False
    ws.problem.is_deficient = False
    return fulfils_laws(ws, is_lenient=False) and _rubs(ws)


@kernel("b1(ws, i8)")
def _search_round(ws: Workspace, solver: int) -> bool:
    """Search with the freed contacts kept from sticking; return 1 if the answer is verified."""
    stages = newton.STAGES
    if solver == GAUSS_SEIDEL:
        stages = gauss_seidel.STAGES
    elif solver == LEMKE:
        stages = lemke.STAGES
    for i in range(3 * ws.problem.n_active):
        ws.problem.forces_at_start[i] = 0.0
    for stage in range(stages):
        if ws.problem.effort >= _MOST_EFFORT or interrupted(ws, ws.problem.n_active):
            return False
        for i in range(3 * ws.problem.n_active):
            ws.problem.forces[i] = ws.problem.forces_at_start[i]
        _write_cones(ws)
        settled = _improve(ws, solver, stage)
        for i in range(3 * ws.problem.n_active):
            ws.problem.forces_at_start[i] = ws.problem.forces[i]
        guess_modes_from_forces(ws)
        _restore_cones(ws)
        if not settled and stage < stages - 1 and _hasty(ws):
            continue
        _keep_found(ws)
        if _try_by_motion(ws):
            return True
        polish(ws)
        if _accept(ws):
            return True
        if ws.problem.is_deficient and _accept_raw(ws):
            return True
        _take_found(ws)
        if settled:
            return False
    return False


@kernel("i8(ws)")
def _free_sliding(ws: Workspace) -> int:
    """Keep the contacts at rest that were found to slide from sticking; return how many that are new."""
    new = 0
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        if active.is_at_rest and active.mode_found == Mode.SLIDE and not active.was_freed:
            active.was_freed = True
            if active.static_coefficient != active.friction_coefficient:
                new += 1
    return new


@kernel("b1(ws, i8)")
def _search_from(ws: Workspace, solver: int) -> bool:
    """Search, and again while contacts are found to slide that the higher static bound might still hold."""
    for _round in range(1 + ws.problem.n_active):
        if _search_round(ws, solver):
            return True
        if _free_sliding(ws) == 0:
            return False
    return False


@kernel()
def _keep_answer(ws: Workspace) -> None:
    _keep_found(ws)
    for i in range(3 * ws.problem.n_active):
        ws.problem.forces_at_start[i] = ws.problem.forces[i]


@kernel()
def _take_answer(ws: Workspace) -> None:
    _take_raw(ws)
    set_scales(ws)


@kernel()
def _close_idle(ws: Workspace) -> None:
    """Of several sets of forces for the motion found take that of all contacts that it leaves closed."""
    _keep_answer(ws)
    if not _guess_by_motion(ws):
        return
    polish(ws)
    if _accept(ws):
        return
    _take_answer(ws)


@kernel()
def _prefer_stick(ws: Workspace) -> None:
    """Between the two bounds a contact at rest may stick and may slide: what is at rest stays so if all can."""
    _keep_answer(ws)
    changed = False
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        undecided = (
            active.is_at_rest
            and active.mode_past != Mode.SLIDE
            and active.static_coefficient != active.friction_coefficient
        )
        if undecided and active.mode_tried == Mode.SLIDE:
            active.mode_tried = Mode.STICK
            changed = True
    if not changed:
        return
    polish(ws)
    if not _accept(ws):
        _take_answer(ws)


@entry_point("b1(ws, i8)")
def find_modes(ws: Workspace, solver: int) -> bool:
    """Search by one solver, ``mode_past`` holding the past modes; return 1 if a verified answer is found."""
    found = False
    if solver == ENUMERATION:
        found = enumerate_modes(ws, 0) > 0
    else:
        for a in range(ws.problem.n_active):
            active = ws.actives[a]
            active.was_freed = False
        # where a contact has just broken away it must not stick again at the higher static bound
        broken = 0
        for a in range(ws.problem.n_active):
            active = ws.actives[a]
            if active.is_at_rest and active.mode_past == Mode.SLIDE:
                active.was_freed = True
                broken += 1
        if broken > 0:
            found = _search_from(ws, solver)
            for a in range(ws.problem.n_active):
                active = ws.actives[a]
                active.was_freed = False
        if not found:
            found = _search_from(ws, solver)
    if found:
        _prefer_stick(ws)
        _close_idle(ws)
    return found
