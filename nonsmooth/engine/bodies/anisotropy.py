"""Anisotropic friction: the tangents are fixed to a body and stretched, so that the friction bound becomes a disc.

The friction coefficient depends on the direction of the slip: it is ``r_1 mu`` along an axis that is fixed to one of
the bodies, and ``r_2 mu`` across it. The bound is then an ellipse. The rows ``r_1 e1`` and ``r_2 e2`` in place of the
unit tangents ``e1`` (along the axis) and ``e2`` (across it) turn the ellipse into a disc of radius ``mu f_n``. So every
solver keeps its isotropic law, and powers are unchanged. The alternative, an elliptic bound in each solver, would need
another projection in each of them.

``r_1`` may differ forward and backward. ``contact.facing`` is 1 if the slip along ``e1`` is forward, else -1. The
geometry keeps its unit tangents. ``stretch_1`` and ``stretch_2`` are the rows along them.
"""

from __future__ import annotations

from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import ContactRecord, Workspace, at, frame_at, kernel
from nonsmooth.engine.numerics.vectors import Pair, Vector, dot, length

_SIDE, _AXIS, _FORWARD, _BACKWARD, _ACROSS = 0, 1, 4, 5, 6
"""Offsets in the parameters of the law: its body (0 is the first), its axis in that body's frame, its three ratios."""
_SMALLEST_SINE = 1e-7
"""Sine of the angle to the normal below which the projection of an axis to the tangent plane is round-off."""


@kernel("i8(v3)")
def _least_axis(axis: Vector) -> int:
    """Index of the component of a vector with the least absolute value. The first one if two are equal.

    The coordinate axis of this index is the one farthest from the direction of the vector.
    """
    x, y, z = axis
    if abs(x) <= abs(y) and abs(x) <= abs(z):
        return 0
    return 1 if abs(y) <= abs(z) else 2


@kernel("void(ws, i8, v3, v3)")
def stretch_tangents(ws: Workspace, c: int, t1: Vector, t2: Vector) -> None:
    """Write the tangential axes of the anisotropic contact ``c``: unit vectors, stretched by the friction ratios.

    Along stretched axes the elliptic friction bound is a disc, so that solvers keep their isotropic law. ``t1`` and
    ``t2`` are the unit tangents of the geometry. ``facing`` selects the ratio, and is updated here: 1 if the slip along
    the law's axis is forward, else -1. A slip within the velocity tolerance does not change it, nor does a contact that
    sticks: its slip in the stages of a step is an error of integration.
    """
    contact, law = ws.contacts[c], at(ws.floats, ws.contacts[c].anisotropy)
    e1, e2 = _projected_axis(ws, contact, t1, t2)
    v1, v2 = contact.slip_of_tangents
    forward = e1 * v1 + e2 * v2
    # in the stages of an implicit step the slip at the end of the stage, which is found later, sets the facing
    is_known = contact.mode != Mode.STICK and ws.problem.stage_time == 0.0
    if is_known and abs(forward) > ws.tolerance.velocity:
        contact.facing = 1 if forward > 0.0 else -1
    along, across = law[_FORWARD] if contact.facing == 1 else law[_BACKWARD], law[_ACROSS]
    # (e1, e2) is the law's axis in components along t1 and t2; (-e2, e1) is the direction across it
    contact.stretch_1, contact.stretch_2 = (along * e1, along * e2), (-across * e2, across * e1)
    contact.axis_1 = _combined(contact.stretch_1, t1, t2)
    contact.axis_2 = _combined(contact.stretch_2, t1, t2)


@kernel("v2(ws, ContactRecord, v3, v3)")
def _projected_axis(ws: Workspace, contact: ContactRecord, t1: Vector, t2: Vector) -> Pair:
    """Unit vector along the projection of the law's axis to the tangent plane, in components along the unit tangents.

    The axis is fixed to one of the two bodies. If it is normal to the tangent plane, it has no projection. Then the
    axis of the body's frame that is farthest from it is used instead, because it turns with the body too.
    """
    law, axis = at(ws.floats, contact.anisotropy), at(ws.floats, contact.anisotropy + _AXIS)
    # the first parameter is the body that carries the axis: 0 the first, 1 the second
    rotation = frame_at(ws.floats, contact.frame_a if law[_SIDE] == 0.0 else contact.frame_b).rotation
    world = (
        rotation[0] * axis[0] + rotation[1] * axis[1] + rotation[2] * axis[2],
        rotation[3] * axis[0] + rotation[4] * axis[1] + rotation[5] * axis[2],
        rotation[6] * axis[0] + rotation[7] * axis[1] + rotation[8] * axis[2],
    )
    p1, p2 = dot(world, t1), dot(world, t2)
    size = length((p1, p2))
    if size < _SMALLEST_SINE:
        r = _least_axis((axis[0], axis[1], axis[2]))
        # axis r of the frame: column r of the rotation matrix, which is stored row by row
        world = rotation[r], rotation[r + 3], rotation[r + 6]
        p1, p2 = dot(world, t1), dot(world, t2)
        size = length((p1, p2))
    return p1 / size, p2 / size


@kernel("v3(v2, v3, v3)")
def _combined(s: Pair, t1: Vector, t2: Vector) -> Vector:
    """Vector ``s[0] t1 + s[1] t2``."""
    return s[0] * t1[0] + s[1] * t2[0], s[0] * t1[1] + s[1] * t2[1], s[0] * t1[2] + s[1] * t2[2]


@kernel("void(ws, i8)")
def stretch_bias(ws: Workspace, c: int) -> None:
    """Transform the tangential bias of contact ``c`` from unit tangents to stretched rows [m/s^2], in place.

    The bias is the acceleration of the contact while all velocities are constant. It transforms as a velocity does.
    """
    contact = ws.contacts[c]
    b1, b2 = contact.bias[1], contact.bias[2]
    (s11, s12), (s21, s22) = contact.stretch_1, contact.stretch_2
    contact.bias[1], contact.bias[2] = s11 * b1 + s12 * b2, s21 * b1 + s22 * b2


@kernel("v2(ws, i8, v2)")
def on_unit_tangents(ws: Workspace, c: int, friction: Pair) -> Pair:
    """Friction force [N] or impulse [N s] of contact ``c`` along the unit tangents, from that along the stretched rows.

    It is the transpose of the map of velocities, so that the power is the same.
    """
    contact = ws.contacts[c]
    (s11, s12), (s21, s22), (f1, f2) = contact.stretch_1, contact.stretch_2, friction
    return s11 * f1 + s21 * f2, s12 * f1 + s22 * f2


@kernel()
def release_sticking_anisotropic(ws: Workspace) -> None:
    """Set sticking anisotropic contacts to sliding, so that their facing follows the slip after an impact.

    The facing is the sense of slip whose friction ratio applies, and a contact that sticks would keep it. To be called
    before the rates after the impact are evaluated.
    """
    for contact in ws.contacts:
        if contact.is_anisotropic and contact.mode == Mode.STICK:
            contact.mode = Mode.SLIDE


@kernel("f8(ws, ContactRecord)")
def stretch_along(ws: Workspace, contact: ContactRecord) -> float:
    """Length of the first stretched tangent of a contact [1]: the ratio of friction along the law's axis.

    It changes with the facing. A force ``f1`` along the stretched tangent is ``f1`` times this ratio along the axis.
    Isotropic friction has ratio 1.
    """
    if not contact.is_anisotropic:
        return 1.0
    law = at(ws.floats, contact.anisotropy)
    return law[_FORWARD] if contact.facing == 1 else law[_BACKWARD]


@kernel("f8(ws, i8, f8)")
def force_in_facing(ws: Workspace, c: int, f1: float) -> float:
    """First tangential force ``f1`` of contact ``c`` [N], scaled to the friction ratio of the slip that it opposes.

    So scaled it can be compared with the static bound. The row of ``f1`` is stretched by the ratio for slip in the
    sense of ``facing``, 1 or -1. A force in that sense opposes slip in the other sense, which has the other ratio. The
    force itself, ratio times ``f1``, is the same along both rows. Isotropic friction leaves ``f1`` as it is.
    """
    contact = ws.contacts[c]
    # a force against the facing opposes slip in the sense of the facing, for which the row is stretched
    if not contact.is_anisotropic or f1 * contact.facing <= 0.0:
        return f1
    law = at(ws.floats, contact.anisotropy)
    ratio = law[_FORWARD] / law[_BACKWARD]
    return f1 * ratio if contact.facing == 1 else f1 / ratio


@kernel("b1(ws, i8, f8)")
def turn_facing(ws: Workspace, c: int, f1: float) -> bool:
    """Set the facing of contact ``c`` to the sense of slip that its first tangential force ``f1`` [N] opposes.

    1 is slip along the axis of the anisotropic law, -1 slip against it. True if this changes the friction ratio, so
    that the force must be found again. Isotropic contacts have no facing, and give False.
    """
    contact = ws.contacts[c]
    # a force against the facing opposes slip in the sense of the facing already
    if not contact.is_anisotropic or f1 * contact.facing <= 0.0:
        return False
    law = at(ws.floats, contact.anisotropy)
    contact.facing = -contact.facing
    return law[_FORWARD] != law[_BACKWARD]
