"""The solver "enumeration" of the contact problem: all combinations of modes are tried until one fulfils the laws.

With n contacts there are 3^n combinations. So this solver is for few contacts, and comes last. It finds a solution
wherever Newton's method finds the slip directions of the right combination. No other solver has this guarantee: with
friction, the contact problem is not a convex one.
"""

from __future__ import annotations

from nonsmooth.engine.contact.cone import gauss_seidel
from nonsmooth.engine.contact.polish import has_slip_that_begins, polish
from nonsmooth.engine.contact.trial import hold_tried, verify
from nonsmooth.engine.delassus.delassus import add_product
from nonsmooth.engine.memory.layout import FIRST_ROW, SECOND_ROW
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.memory.solvers import MOST_ENUMERATED
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.vectors import length

_SWEEPS = 100
"""Maximum number of sweeps for a first guess of slip directions. Newton's method makes them exact."""
_NO_BOUND = 1e30
"""Static coefficient of a contact that must stick. No friction is so much larger than its normal force."""


@entry_point("i8(ws, i8)")
def enumerate_modes(ws: Workspace, first: int) -> int:
    """Try the combinations of modes from number ``first`` on. Returns the number after the first solution, or 0.

    Slips that begin get two guesses of their direction: along the acceleration without their friction, and, if Newton's
    method does not lead from there to a solution, from sweeps.
    """
    if ws.problem.n_active > MOST_ENUMERATED:
        return 0
    for number in range(first, 3**ws.problem.n_active):
        if interrupted(ws, ws.problem.n_active):
            return 0
        if not _write_modes(ws, number):
            continue
        has_slip = has_slip_that_begins(ws)
        if has_slip:
            _guess_directions(ws)
            polish(ws)
        if verify(ws, is_lenient=False):
            return number + 1
        if has_slip:
            _guess_directions_by_sweeps(ws)
            polish(ws)
            if verify(ws, is_lenient=False):
                return number + 1
    return 0


@kernel("b1(ws, i8)")
def _write_modes(ws: Workspace, number: int) -> bool:
    """Write the modes of combination ``number``, its digits to base 3. False if a contact that slips would stick."""
    for active in ws.actives:
        digit = number % 3
        number //= 3
        active.mode_tried = Mode.STICK if digit == 0 else (Mode.SLIDE if digit == 1 else Mode.OPEN)
        if active.mode_tried == Mode.STICK and not active.is_at_rest:
            return False
    return True


@kernel()
def _guess_directions(ws: Workspace) -> None:
    """Guess the directions of slips that begin along their accelerations without friction of the contacts at rest."""
    for active in ws.actives:
        active.coefficient_kept = active.friction_coefficient
        if active.is_at_rest:
            active.friction_coefficient = 0.0
    hold_tried(ws)
    for active in ws.actives:
        active.friction_coefficient = active.coefficient_kept
    forces = ws.problem.forces.start
    for active in ws.actives:
        if not active.is_at_rest or active.mode_tried != Mode.SLIDE:
            continue
        a1 = add_product(ws, active.free[FIRST_ROW], active.index, FIRST_ROW, forces)
        a2 = add_product(ws, active.free[SECOND_ROW], active.index, SECOND_ROW, forces)
        norm = length((a1, a2))
        active.direction = a1 / norm if norm > 0.0 else 1.0, a2 / norm if norm > 0.0 else 0.0


@kernel()
def _guess_directions_by_sweeps(ws: Workspace) -> None:
    """Guess the directions of slips that begin by sweeps with fixed modes.

    Newton's method may have converged to a slip along its friction. Sweeps exclude that.
    """
    for active in ws.actives:
        active.is_normal_force_unknown = active.mode_tried != Mode.OPEN
        active.static_kept = active.static_coefficient
        active.static_coefficient = _NO_BOUND if active.mode_tried == Mode.STICK else 0.0
        for r in range(3):
            active.force[r] = 0.0
    gauss_seidel(ws, _SWEEPS)
    for active in ws.actives:
        active.static_coefficient = active.static_kept
