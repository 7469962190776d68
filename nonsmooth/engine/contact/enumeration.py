"""The solver "enumeration" of the contact problem: all combinations of modes are tried until one fulfils the laws.

With n contacts there are 3^n combinations. So this solver is for few contacts, and comes last. It finds a solution
wherever Newton's method finds the slip directions of the right combination. No other solver has this guarantee: with
friction, the contact problem is not a convex one.
"""

from __future__ import annotations

from nonsmooth.engine.contact.cone import gauss_seidel
from nonsmooth.engine.contact.slip_directions import find_slip_directions, has_slip_that_begins
from nonsmooth.engine.contact.trial import find_tried_forces, verify
from nonsmooth.engine.contact.unknowns import starts_to_slide
from nonsmooth.engine.delassus.delassus import slip_acceleration
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.memory.solvers import MOST_ENUMERATED
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel
from nonsmooth.engine.native.watch import interrupted
from nonsmooth.engine.numerics.arrays import clear
from nonsmooth.engine.numerics.integers import power
from nonsmooth.engine.numerics.vectors import unit

_SWEEPS = 100
"""Maximum number of sweeps for a first guess of slip directions. Newton's method makes them exact."""
_NO_BOUND = 1e30
"""Static coefficient of a contact that must stick. No friction is so much larger than its normal force."""


@entry_point("i8(ws, i8)")
def enumerate_modes(ws: Workspace, first: int) -> int:
    """Try the combinations of modes from number ``first`` on. Returns the number after the first that fulfils the laws.

    From there a caller may search for further solutions. 0 means that none fulfils them, that there are more than
    ``MOST_ENUMERATED`` contacts, or an interrupt. Slips that begin get two guesses of their
    direction: along the acceleration without their friction, and, if Newton's method does not lead from there to a
    solution, from sweeps.
    """
    if ws.problem.n_active > MOST_ENUMERATED:
        return 0
    # stick, slide or open for each contact
    for number in range(first, power(3, ws.problem.n_active)):
        if interrupted(ws, ws.problem.n_active):
            return 0
        # a contact that slips cannot stick
        if not _write_modes(ws, number):
            continue
        has_slip = has_slip_that_begins(ws)
        if has_slip:
            _guess_directions(ws)
            # directions that have not converged fail the laws
            find_slip_directions(ws)
        if verify(ws, is_lenient=False) or (has_slip and _verify_by_sweeps(ws)):
            return number + 1
    return 0


@kernel("b1(ws, i8)")
def _write_modes(ws: Workspace, number: int) -> bool:
    """Write the modes of combination ``number``: its digits to base 3, of which 0 is stick, 1 slide and 2 open.

    False if a contact that slips would stick: this combination needs no trial.
    """
    for active in ws.actives:
        digit = number % 3
        number //= 3
        active.mode_tried = Mode.STICK if digit == 0 else (Mode.SLIDE if digit == 1 else Mode.OPEN)
        if active.mode_tried == Mode.STICK and not active.is_at_rest:
            return False
    return True


@kernel()
def _guess_directions(ws: Workspace) -> None:
    """Guess the directions of slips that begin: those of the slip accelerations if contacts at rest had no friction.

    The friction coefficients are restored. The forces are overwritten.
    """
    for active in ws.actives:
        active.coefficient_kept = active.friction_coefficient
        if active.is_at_rest:
            active.friction_coefficient = 0.0
    find_tried_forces(ws)
    for active in ws.actives:
        active.friction_coefficient = active.coefficient_kept
    for active in ws.actives:
        if starts_to_slide(active):
            active.direction = unit(slip_acceleration(ws, active))


@kernel("b1(ws)")
def _verify_by_sweeps(ws: Workspace) -> bool:
    """Guess the directions of slips that begin by sweeps with fixed modes. True if the modes then fulfil the laws.

    Newton's method may have converged to a slip in the direction of its friction, where the product a_t x d vanishes,
    too. Where sweeps settle, the slip is against its friction. The static coefficients are restored.
    """
    for active in ws.actives:
        active.is_normal_force_unknown = active.mode_tried != Mode.OPEN
        active.static_kept = active.static_coefficient
        # the bound fixes the mode: friction always sticks, or never
        active.static_coefficient = _NO_BOUND if active.mode_tried == Mode.STICK else 0.0
    # the sweeps start without forces
    clear(ws.floats, ws.problem.forces.start, 3 * ws.problem.n_active)
    gauss_seidel(ws, _SWEEPS)
    for active in ws.actives:
        active.static_coefficient = active.static_kept
    find_slip_directions(ws)
    return verify(ws, is_lenient=False)
