"""Contacts at one place: features of two bodies that hold together for a moment while one gives way to the other.

Where a body rolls from an edge onto a face, both are touched as long as the margins about their border overlap, and the
rates of their gaps differ by the turning over the way between the points.  No impulse tells such contacts apart: they
are one, and the one that approaches more stands for it.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.compliance import begin_contact
from nonsmooth.engine.memory.blocks import GEOMETRY, NORMAL, POINT_B
from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel

_SAME = 1e-5
"""Difference of normals, and of places in units of the smaller body, up to which contacts are one: the share of an
approach that its square is of an energy is less than what is promised of one."""


@kernel("i8(S, F, I, i8, i8)")
def _is_twin(S: Scalars, w: Floats, k: Integers, c: int, other: int) -> int:
    """Return 1 if two rigid contacts of the same frames are at one place."""
    if c == other or k[S.frame_a + c] != k[S.frame_a + other] or k[S.frame_b + c] != k[S.frame_b + other]:
        return 0
    if k[S.normal_function + c] != 0 or k[S.normal_function + other] != 0:
        return 0
    one, two = S.geometry + GEOMETRY * c, S.geometry + GEOMETRY * other
    normal = place = 0.0
    for i in range(3):
        normal += (w[one + NORMAL + i] - w[two + NORMAL + i]) ** 2
        place += (w[one + POINT_B + i] - w[two + POINT_B + i]) ** 2
    return 1 if normal <= _SAME**2 and place <= (_SAME * w[S.size + c]) ** 2 else 0


@kernel("i8(S, F, I, i8)")
def closed_twin(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return a closed contact at the place of ``c`` that does not approach, or -1."""
    for other in range(S.n_contacts):
        closed = k[S.mode + other] != OPEN and w[S.rate + 3 * other] >= -S.velocity_tolerance
        if closed and _is_twin(S, w, k, c, other) == 1:
            return other
    return -1


@kernel("i8(S, F, I, i8)")
def has_replaced(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return 1 if a contact has taken the place of one that was closed before the event, without a collision."""
    for other in range(S.n_contacts):
        if k[S.code_before + other] != 0 and k[S.mode + other] == OPEN and _is_twin(S, w, k, c, other) == 1:
            return 1 if k[S.mode + c] != OPEN else 0
    return 0


@kernel("i8(S, F, I, i8)")
def take_over(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Close a contact in place of those at its place; return 1, or 0 if there are none."""
    twin, taken = closed_twin(S, w, k, c), 0
    while twin >= 0:
        if taken == 0:
            if k[S.mode + c] == OPEN:
                begin_contact(S, w, k, c)
            k[S.mode + c] = k[S.mode + twin]
            taken = 1
        k[S.mode + twin] = OPEN
        k[S.member + twin] = 0
        twin = closed_twin(S, w, k, c)
    return taken
