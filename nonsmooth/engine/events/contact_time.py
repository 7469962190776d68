"""Islands in which nothing moves by more than a contact time of their accelerations: bounces there count as none."""

from __future__ import annotations

from nonsmooth.engine.bodies.compliance import push_compliant
from nonsmooth.engine.bodies.kinematics import row
from nonsmooth.engine.contact.problem import free_acceleration
from nonsmooth.engine.delassus.delassus import add_product, assemble_delassus
from nonsmooth.engine.delassus.islands import activate_group, group_touching
from nonsmooth.engine.impact.instant import inelastic_impulses
from nonsmooth.engine.memory.modes import OPEN, SLIDE, STICK
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, active_at, contact_at, kernel
from nonsmooth.engine.numerics.vectors import length


@kernel("i8(S, F, I)")
def _approaches(S: Scalars, w: Floats, k: Integers) -> int:
    """Return 1 if an active contact approaches."""
    for a in range(S.n_active):
        if contact_at(S, w, k, active_at(S, w, k, a).slot).rate[0] < -S.velocity_tolerance:
            return 1
    return 0


@kernel("f8(S, F, I)")
def slow_time(S: Scalars, w: Floats, k: Integers) -> float:
    """Return the contact time of the active contacts if they are slow, or 0 [s].

    It is the shortest of theirs; they are slow if no gap changes faster than the greatest approach of the free
    accelerations, which must be written, makes of it within that time: Eq. (33), of an island in place of a contact.
    """
    time, approach, fastest = 1e300, 0.0, 0.0
    for a in range(S.n_active):
        c = active_at(S, w, k, a).slot
        contact = contact_at(S, w, k, c)
        time = min(time, contact.contact_time)
        approach = max(approach, -(contact.bias[0] + row(S, w, k, c, 0, S.du)))
        fastest = max(fastest, abs(contact.rate[0]))
    return time if fastest <= approach * time else 0.0


@kernel("i8(S, F, I, f8)")
def _choose_modes(S: Scalars, w: Floats, k: Integers, time: float) -> int:
    """Give the active contacts the modes that they have after so much ``time``; return 1, or 0 where none are found.

    What presses until then is closed, what has come to rest by then sticks.
    """
    assemble_delassus(S, w, k)
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        contact = contact_at(S, w, k, active.slot)
        for r in range(3):
            active.free[r] = contact.bias[r] + row(S, w, k, active.slot, r, S.du)
    if inelastic_impulses(S, w, k, time) == 0:
        return 0
    for a in range(S.n_active):
        active = active_at(S, w, k, a)
        contact = contact_at(S, w, k, active.slot)
        v1 = add_product(S, w, k, active.free[1], a, 1, S.active_forces)
        v2 = add_product(S, w, k, active.free[2], a, 2, S.active_forces)
        contact.mode_agreed = OPEN
        if active.normal_force > 0.0:
            contact.mode_agreed = SLIDE if length((v1, v2)) > S.velocity_tolerance else STICK
    return 1


@kernel("i8(S, F, I)")
def slow_modes(S: Scalars, w: Floats, k: Integers) -> int:
    """Agree on the modes that slow islands in which a contact approaches have at the end of a contact time.

    Return how many such islands there are, or 0 where one approaches that is not slow, or whose modes are not found.
    """
    for c in range(S.n_contacts):
        contact = contact_at(S, w, k, c)
        contact.mode_agreed = contact.mode
    free_acceleration(S, w, k, 1)
    push_compliant(S, w, k)
    group_touching(S, w, k)
    slow = 0
    for group in range(S.n_groups):
        activate_group(S, w, k, group)
        if _approaches(S, w, k) == 1:
            if slow_time(S, w, k) == 0.0:
                return 0
            slow += 1
    for group in range(S.n_groups):
        activate_group(S, w, k, group)
        if _approaches(S, w, k) == 1 and _choose_modes(S, w, k, slow_time(S, w, k)) == 0:
            return 0
    return slow
