"""Friction that is not the same in all directions: tangents fixed to a body, so stretched that its bound is a disc.

Of such a contact the tangential rows of ``axes`` are r_1 e1 and r_2 e2, with e1 forward along the law's axis, e2 across
it, and r the law's ratios.  Where the axis stands along the normal, the axis of the body's frame that is least along
it takes its place.  Slip velocities, forces and impulses along them are those that the solvers see, and powers
stay what they are.  The geometry keeps its own tangents, of unit length; ``skew`` leads from these to the rows.
"""

from __future__ import annotations

import math

from nonsmooth.engine.memory.blocks import ROTATION
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel

_SIDE, _AXIS, _FORWARD, _BACKWARD, _ACROSS = 0, 1, 4, 5, 6
"""Where these numbers of the law stand: the body that it is fixed to, its axis, and its ratios."""
_UPRIGHT = 1e-7
"""Sine of the angle to the normal below which an axis has no direction in the tangent plane, but that of round-off."""


@kernel("i8(f8, f8, f8)")
def _least(x: float, y: float, z: float) -> int:
    """Return the number of the axis of the body's frame that is least along a vector, the first of equals."""
    if abs(x) <= abs(y) and abs(x) <= abs(z):
        return 0
    return 1 if abs(y) <= abs(z) else 2


@kernel("void(S, F, I, i8, i8)")
def stretch_tangents(S: Scalars, w: Floats, k: Integers, c: int, tangents: int) -> None:
    """Write the tangential rows of ``axes`` of contact ``c``, ``slip`` being known.

    ``tangents`` says where the unit tangents stand, one after the other.
    """
    law, axis = k[S.axis + c], k[S.axis + c] + _AXIS
    frame = k[S.frame_a + c] if w[law + _SIDE] == 0.0 else k[S.frame_b + c]
    p1 = p2 = 0.0
    for i in range(3):
        r = frame + ROTATION + 3 * i
        world = w[r] * w[axis] + w[r + 1] * w[axis + 1] + w[r + 2] * w[axis + 2]
        p1 += world * w[tangents + i]
        p2 += world * w[tangents + 3 + i]
    length = math.sqrt(p1 * p1 + p2 * p2)
    if length < _UPRIGHT:
        # another axis of the body in its place: a direction that turns with the body, whoever looks on
        r = frame + ROTATION + _least(w[axis], w[axis + 1], w[axis + 2])
        p1 = w[r] * w[tangents] + w[r + 3] * w[tangents + 1] + w[r + 6] * w[tangents + 2]
        p2 = w[r] * w[tangents + 3] + w[r + 3] * w[tangents + 4] + w[r + 6] * w[tangents + 5]
        length = math.sqrt(p1 * p1 + p2 * p2)
    e1, e2 = p1 / length, p2 / length
    v1, v2 = w[S.slip + 2 * c], w[S.slip + 2 * c + 1]
    forward = e1 * v1 + e2 * v2
    if abs(forward) > S.velocity_tolerance:
        k[S.facing + c] = 1 if forward > 0.0 else -1
    along = w[law + _FORWARD] if k[S.facing + c] == 1 else w[law + _BACKWARD]
    skew = S.skew + 4 * c
    w[skew], w[skew + 1] = along * e1, along * e2
    w[skew + 2], w[skew + 3] = -w[law + _ACROSS] * e2, w[law + _ACROSS] * e1
    for r in range(2):
        s1, s2 = w[skew + 2 * r], w[skew + 2 * r + 1]
        for i in range(3):
            w[S.axes + 9 * c + 3 + 3 * r + i] = s1 * w[tangents + i] + s2 * w[tangents + 3 + i]


@kernel("void(S, F, I, i8, i8)")
def stretch_bias(S: Scalars, w: Floats, k: Integers, c: int, bias: int) -> None:
    """Turn the tangential second-order terms at ``bias`` from the unit tangents to the rows."""
    b1, b2, skew = w[bias + 1], w[bias + 2], S.skew + 4 * c
    w[bias + 1] = w[skew] * b1 + w[skew + 1] * b2
    w[bias + 2] = w[skew + 2] * b1 + w[skew + 3] * b2


@kernel("void(S, F, I, i8, i8)")
def unstretch_force(S: Scalars, w: Floats, k: Integers, c: int, force: int) -> None:
    """Turn the force or impulse at ``force`` from the rows to the unit tangents."""
    f1, f2, skew = w[force + 1], w[force + 2], S.skew + 4 * c
    w[force + 1] = w[skew] * f1 + w[skew + 2] * f2
    w[force + 2] = w[skew + 1] * f1 + w[skew + 3] * f2


@kernel("f8(S, F, I, i8, f8)")
def facing_force(S: Scalars, w: Floats, k: Integers, c: int, f1: float) -> float:
    """Return the first tangential force as it is along the row of the slip that it opposes."""
    if k[S.oriented + c] == 0 or f1 * k[S.facing + c] <= 0.0:
        return f1
    law = k[S.axis + c]
    ratio = w[law + _FORWARD] / w[law + _BACKWARD]
    return f1 * ratio if k[S.facing + c] == 1 else f1 / ratio


@kernel("i8(S, F, I, i8, f8)")
def turn_facing(S: Scalars, w: Floats, k: Integers, c: int, f1: float) -> int:
    """Let contact ``c`` face against its first tangential force; return 1 if it did not."""
    if k[S.oriented + c] == 0 or f1 * k[S.facing + c] <= 0.0:
        return 0
    law = k[S.axis + c]
    k[S.facing + c] = -k[S.facing + c]
    return 1 if w[law + _FORWARD] != w[law + _BACKWARD] else 0
