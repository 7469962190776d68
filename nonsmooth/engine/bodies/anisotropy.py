"""Friction that is not the same in all directions: tangents fixed to a body, so stretched that its bound is a disc.

Of such a contact the tangential rows of ``axes`` are r_1 e1 and r_2 e2, with e1 forward along the law's axis, e2 across
it, and r the law's ratios.  Where the axis stands along the normal, the axis of the body's frame that is least along
it takes its place.  Slip velocities, forces and impulses along them are those that the solvers see, and powers
stay what they are.  The geometry keeps its own tangents, of unit length; ``skew`` leads from these to the rows.
"""

from __future__ import annotations

from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, at, frame_at, kernel
from nonsmooth.engine.numerics.vectors import Pair, Vector, dot, length

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


@kernel("void(ws, i8, v3, v3)")
def stretch_tangents(ws: Workspace, c: int, t1: Vector, t2: Vector) -> None:
    """Write the tangential rows of ``axes`` of contact ``c``, the slip along the unit tangents being known."""
    contact = ws.contacts[c]
    law, axis = at(ws.floats, contact.anisotropy), at(ws.floats, contact.anisotropy + _AXIS)
    rotation = frame_at(ws.floats, contact.frame_a if law[_SIDE] == 0.0 else contact.frame_b).rotation
    world = (
        rotation[0] * axis[0] + rotation[1] * axis[1] + rotation[2] * axis[2],
        rotation[3] * axis[0] + rotation[4] * axis[1] + rotation[5] * axis[2],
        rotation[6] * axis[0] + rotation[7] * axis[1] + rotation[8] * axis[2],
    )
    p1, p2 = dot(world, t1), dot(world, t2)
    size = length((p1, p2))
    if size < _UPRIGHT:
        # another axis of the body in its place: a direction that turns with the body, whoever looks on
        r = _least(axis[0], axis[1], axis[2])
        world = rotation[r], rotation[r + 3], rotation[r + 6]
        p1, p2 = dot(world, t1), dot(world, t2)
        size = length((p1, p2))
    e1, e2 = p1 / size, p2 / size
    v1, v2 = contact.slip_of_tangents
    forward = e1 * v1 + e2 * v2
    # one that sticks faces against what holds it: in the stages of a step its slip is not quite none
    if contact.mode != Mode.STICK and abs(forward) > ws.tolerance.velocity:
        contact.facing = 1 if forward > 0.0 else -1
    along, across = law[_FORWARD] if contact.facing == 1 else law[_BACKWARD], law[_ACROSS]
    contact.stretch_1, contact.stretch_2 = (along * e1, along * e2), (-across * e2, across * e1)
    contact.axis_1 = _between(contact.stretch_1, t1, t2)
    contact.axis_2 = _between(contact.stretch_2, t1, t2)


@kernel("v3(v2, v3, v3)")
def _between(s: Pair, t1: Vector, t2: Vector) -> Vector:
    return s[0] * t1[0] + s[1] * t2[0], s[0] * t1[1] + s[1] * t2[1], s[0] * t1[2] + s[1] * t2[2]


@kernel("void(ws, i8)")
def stretch_bias(ws: Workspace, c: int) -> None:
    """Turn the tangential second-order terms of contact ``c`` from the unit tangents to the rows."""
    contact = ws.contacts[c]
    b1, b2 = contact.bias[1], contact.bias[2]
    (s11, s12), (s21, s22) = contact.stretch_1, contact.stretch_2
    contact.bias[1], contact.bias[2] = s11 * b1 + s12 * b2, s21 * b1 + s22 * b2


@kernel("v2(ws, i8, v2)")
def along_tangents(ws: Workspace, c: int, friction: Pair) -> Pair:
    """Return a force or impulse of friction, given along the rows, along the unit tangents."""
    contact = ws.contacts[c]
    (s11, s12), (s21, s22), (f1, f2) = contact.stretch_1, contact.stretch_2, friction
    return s11 * f1 + s21 * f2, s12 * f1 + s22 * f2


@kernel()
def face_slips(ws: Workspace) -> None:
    """Let contacts that stuck before an impact face against the slip that it leaves."""
    for c in range(ws.island.n_contacts):
        contact = ws.contacts[c]
        if contact.is_anisotropic and contact.mode == Mode.STICK:
            contact.mode = Mode.SLIDE


@kernel("f8(ws, i8, f8)")
def facing_force(ws: Workspace, c: int, f1: float) -> float:
    """Return the first tangential force as it is along the row of the slip that it opposes."""
    contact = ws.contacts[c]
    if not contact.is_anisotropic or f1 * contact.facing <= 0.0:
        return f1
    law = at(ws.floats, contact.anisotropy)
    ratio = law[_FORWARD] / law[_BACKWARD]
    return f1 * ratio if contact.facing == 1 else f1 / ratio


@kernel("b1(ws, i8, f8)")
def turn_facing(ws: Workspace, c: int, f1: float) -> bool:
    """Let contact ``c`` face against its first tangential force; return 1 if it did not."""
    contact = ws.contacts[c]
    if not contact.is_anisotropic or f1 * contact.facing <= 0.0:
        return False
    law = at(ws.floats, contact.anisotropy)
    contact.facing = -contact.facing
    return law[_FORWARD] != law[_BACKWARD]
