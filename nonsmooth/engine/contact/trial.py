"""A trial of the contact problem: modes guessed from forces, and the one test that every answer must pass."""

from __future__ import annotations

from nonsmooth.engine.contact.distribution import distribute
from nonsmooth.engine.contact.forces import friction_of_slip, reduced_coefficient, resolve
from nonsmooth.engine.delassus.delassus import add_product, diagonal_block
from nonsmooth.engine.memory.blocks import DELASSUS
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, entry_point, kernel
from nonsmooth.engine.numerics.vectors import length

NO_FORCE = 1e-9
"""Part of the accelerations, and of the forces, that counts as zero among them."""
_SOLVED = 1e-5
"""Part of what counts as zero in an island that round-off of its largest forces leaves in all of them."""
_ARRIVED = 0.1
"""Forces may be out of their cones by this part of what counts as zero among them, where they are distributed."""
EQUAL = 1e3
"""Accelerations that tell modes, and those on which more contacts than can hold independently may disagree, may be so
many times what counts as zero."""


@kernel()
def hold_tried(ws: Workspace) -> None:
    """Translate the modes under trial into what is held, and find the forces that hold it."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        mode = active.mode_tried
        active.is_normal_force_unknown = not (mode == Mode.OPEN or active.has_given_force)
        # nothing holds what has no friction: it is at rest by chance
        active.sticks = mode == Mode.STICK and active.static_coefficient > 0.0
        if mode == Mode.OPEN:
            active.normal_force = 0.0
    resolve(ws)
    ws.totals.n_evaluations += 1
    ws.problem.effort += float(ws.problem.n_unknown) ** 3


@kernel()
def set_scales(ws: Workspace) -> None:
    """Write the accelerations and what counts as zero among them and among the forces."""
    # the accelerations that may cancel one another in b set the scale, not b itself
    scale = ws.problem.acceleration_scale
    force_scale = 0.0
    for i in range(3 * ws.problem.n_active):
        force_scale = max(force_scale, abs(ws.problem.forces[i]))
    for a in range(ws.problem.n_active):
        own = diagonal_block(ws, a).nn
        if own > 0.0:
            force_scale = max(force_scale, scale / own)
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        for r in range(3):
            total = active.free[r]
            for block in range(active.first_block, active.end_block):
                force = ws.actives[ws.island.block_column[block]].force
                for s in range(3):
                    part = ws.island.delassus[DELASSUS * block + 3 * r + s] * force[s]
                    total += part
                    scale = max(scale, abs(part))
            active.acceleration[r] = total
    ws.problem.small_acceleration, ws.problem.small_force = NO_FORCE * scale, NO_FORCE * force_scale


@kernel("f8(ws, i8)")
def small_force(ws: Workspace, a: int) -> float:
    """Return what counts as zero among the forces of one contact: beside a heavy body a light one has its own scale."""
    active = ws.actives[a]
    own, size = diagonal_block(ws, a).nn, 0.0
    for r in range(3):
        size = max(size, abs(active.force[r]))
    if own > 0.0:
        size = max(size, ws.problem.acceleration_scale / own)
    return float(NO_FORCE * size + _SOLVED * ws.problem.small_force)


@entry_point("b1(ws, b1)")
def verify(ws: Workspace, is_lenient: bool) -> bool:
    """Find the forces of the modes under trial; return 1 if modes and forces fulfil the laws themselves.

    Where the forces are not unique those of least norm are found; where they break Coulomb's bound, others that
    give the same motion and keep it are looked for, and the modes pass iff there are such; a lenient look does so
    where they pull, too.
    """
    hold_tried(ws)
    return judge(ws, is_lenient)


@kernel("i8(ws, b1)")
def _compare(ws: Workspace, is_lenient: bool) -> int:
    """Return 1 if the forces fulfil the laws, 2 if others that are as good may, 0 if not."""
    set_scales(ws)
    small = ws.problem.small_acceleration
    held = small if not ws.problem.is_deficient else EQUAL * small
    result = 1
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        mode, faint = active.mode_tried, small_force(ws, a)
        normal = active.normal_acceleration
        if mode == Mode.OPEN:
            if not normal >= -small:
                return 0
            continue
        if not abs(normal) <= held:
            return 0
        # sliding on which more force gives more approach is balanced on an edge, and falls off either side
        if mode == Mode.SLIDE and not active.is_at_rest and reduced_coefficient(ws, a) <= 0.0:
            return 0
        if not active.normal_force >= -faint:
            if not is_lenient or not ws.problem.is_deficient:
                return 0
            result = 2
        a1, a2 = active.slip_acceleration
        if mode == Mode.STICK:
            if not abs(a1) + abs(a2) <= held:
                return 0
            if not length(active.friction) <= active.static_coefficient * active.normal_force + faint:
                if not active.has_redundant_force:
                    return 0
                result = 2
        elif active.is_at_rest:
            forward = a1 * active.direction[0] + a2 * active.direction[1]
            across = a1 * active.direction[1] - a2 * active.direction[0]
            if not (forward >= -small and abs(across) <= small):
                return 0
    return result


@kernel("b1(ws, b1)")
def judge(ws: Workspace, is_lenient: bool) -> bool:
    """Return 1 if the ``active_forces`` fulfil the laws in the modes under trial, distributed where not unique."""
    result = _compare(ws, is_lenient)
    if result == 2 and distribute(ws, 0.0, _ARRIVED * ws.problem.small_force):
        # the share of sliding contacts may have moved with their normal forces: all is looked at again
        for a in range(ws.problem.n_active):
            if ws.actives[a].mode_tried == Mode.SLIDE:
                friction_of_slip(ws, a)
        result = _compare(ws, is_lenient)
    return result == 1


@kernel()
def identify(ws: Workspace) -> None:
    """Guess modes and directions from the ``active_forces``, by the side of the natural map on which they stand."""
    for a in range(ws.problem.n_active):
        active = ws.actives[a]
        push = 0.0
        for r in range(3):
            total = add_product(ws, active.free[r], a, r, ws.problem.forces.start)
            if r == 0:
                push = active.normal_force * diagonal_block(ws, a).nn - total
            active.acceleration[r] = total
        active.mode_tried = Mode.SLIDE
        if active.is_at_rest:
            g = slope_of_slip(ws, a)
            y1 = g * active.friction[0] - active.slip_acceleration[0]
            y2 = g * active.friction[1] - active.slip_acceleration[1]
            norm = length((y1, y2))
            if norm > 0.0:
                active.direction = -y1 / norm, -y2 / norm
            if not active.was_freed and norm <= g * active.friction_coefficient * active.normal_force:
                active.mode_tried = Mode.STICK
        if push <= 0.0:
            active.mode_tried = Mode.OPEN


@kernel("f8(ws, i8)")
def slope_of_slip(ws: Workspace, a: int) -> float:
    """Return how fast contact ``a`` slips under a unit of its own friction, or a number like it where it cannot."""
    own = diagonal_block(ws, a)
    largest = max(own.t11, own.t22)
    return float(largest if largest > 0.0 else own.nn)
