"""The blocks that plug-ins write, of bodies, contacts, joints and loads, and the positions of the numbers in them.

Every body owns an output block, written by its ``evaluate`` function, with the parts below in this
order.  The parts down to the Jacobian belong to a frame and are repeated for every frame of the body; :data:`FRAME`
floats of frame motion are all that a driven body writes.

========================  ===============  =====================================================
part                      size             meaning
========================  ===============  =====================================================
``POSITION``              3                of the origin of the body frame [m]
``ROTATION``              9                body axes as columns, row by row
``VELOCITY``              3                of the origin [m/s]
``SPIN``                  3                angular velocity, in world axes [rad/s]
``ACCELERATION``          3                of the origin while u' = 0 [m/s^2]
``SPIN_ACCELERATION``     3                in world axes while u' = 0 [rad/s^2]
``JACOBIAN``              6 n_u            of (velocity, angular velocity) with respect to u
coordinate rates          n_q              dq/dt = B u
force                     n_u              h of M u' = h + W lambda_N + N lambda_T
inverse mass              n_u n_u          M^-1
energy                    2                kinetic and potential [J]
========================  ===============  =====================================================

The geometry block of a contact holds ``GAP``, ``NORMAL`` (from the first body to the second), first
``TANGENT``, witness points ``POINT_A`` and ``POINT_B`` on both bodies and, for either surface, at ``SIDE_A`` and
``SIDE_B``, the matrices ``SLIDE_MATRIX`` and ``TURN_MATRIX`` of
``slide @ u = turn @ nu``: the witness sliding at u over the body turns the normal by nu (both in the
tangent plane; they commute).  A sphere of radius r has slide 1, turn r; a plane slide 0, turn 1; a vertex slide 1,
turn 0.  A point contact needs a curved or sharp side: two planes have none.  Then comes ``FEATURE``, the number of the
pair of features that are in contact, an index of ``FeaturePair.features``, and last, at ``PAST_END``, how far the
witness points are past the ends of features that end, such as edges and the faces of a polyhedron [m]: negative within,
0 where nothing ends.  Past an end the gap is a positive number that no rate belongs to, and
a closed contact opens.

A joint writes :data:`JOINT_ROW` floats per row: ``RESIDUAL`` [m or 1], ``AXIS`` and ``MOMENT``, a point on either body
at ``POINT_A`` and ``POINT_B`` as in a geometry block, and ``ROW_BIAS``.
The row's rate is axis . (velocity of the second body at its point - of the first at its own) + moment . (difference
of the angular velocities); the bias is its derivative while u' = 0.

A load writes ``FORCE`` [N] on the second body, the point where it acts at ``LOAD_POINT`` [m], and ``LOAD_MOMENT``
[N m]; the first body gets the opposite.
"""

from __future__ import annotations

POSITION, ROTATION, VELOCITY, SPIN, ACCELERATION, SPIN_ACCELERATION, JACOBIAN = 0, 3, 12, 15, 18, 21, 24
"""Offsets in the block of a frame.

They are those of origin [m], rotation matrix [1], velocity of the origin [m/s], angular velocity [rad/s], acceleration
of the origin [m/s^2], angular acceleration [rad/s^2], and Jacobian of both velocities.
"""
FRAME = JACOBIAN
"""Floats of frame motion at the head of a body's output block."""
GAP, NORMAL, TANGENT, POINT_A, POINT_B, SIDE_A, SIDE_B, FEATURE, PAST_END = 0, 1, 4, 7, 10, 13, 21, 29, 30
"""Offsets in a geometry block: gap [m], normal, first tangent, witness points [m], matrices of both surfaces.

Then come the number of the pair of features in contact, and the distance past the ends of the features [m].
"""
SLIDE_MATRIX, TURN_MATRIX = 0, 4
"""Offsets of the matrices in ``slide @ u = turn @ nu`` of a surface, from ``SIDE_A`` or ``SIDE_B``.

A contact point that slides at u over the surface turns the normal by nu. Each matrix is 2 x 2, stored row by row.
"""
PAIR = 31
"""Floats of a geometry block that a kinematics writes."""
GUARD = 8
"""Floats behind each block that a plug-in writes. A changed value shows that the plug-in wrote past its block."""
UNTOUCHED = 1.2345678901234567e-89
"""Value of the ``GUARD`` floats before a plug-in writes: a number that no plug-in writes by chance."""
GEOMETRY = PAIR + GUARD
"""Floats of a contact's geometry block."""
RESIDUAL, AXIS, MOMENT, ROW_BIAS = 0, 1, 4, 13
"""Offsets of residual, axis, moment and bias in a joint's row; the points are at ``POINT_A`` and ``POINT_B``."""
JOINT_ROW = 14
"""Floats of one row of a joint."""
FORCE, LOAD_POINT, LOAD_MOMENT = 0, 3, 6
"""Offsets of force [N], point of attack [m] and moment [N m] in the block of a load."""
LOAD = 9
"""Floats that a load writes."""
TRACTION, TRACTION_MOMENT = 0, 2
"""Offsets of force [N] and moment [N m] in the block of a traction law."""
FORCE_AND_MOMENT = 5
"""Number of floats of force (2) and moment (3) in the block of a traction law. The rates of its states follow."""
DELASSUS = 9
"""Floats of a block of the Delassus matrix, row by row."""
PART_PLACE, PART_AXES, PART_SEMI, PART_POWERS, PART_BALL, PART_RADIUS = 0, 3, 12, 15, 17, 18
"""Positions of the numbers of a convex part (:class:`nonsmooth.interfaces.ConvexPart`): its origin and axes in the
frame of its body, semi-axes and powers of the norm that is added to the hull of its circles, radius of the ball that is
added, and radius of a ball about the origin that contains the part."""
PART_FUNCTION, PART_COUNT, PART_RINGS = 19, 20, 21
"""Positions of the address of a support function that is added instead of the norm, or 0; of the number of circles, -1
for a half-space below the origin; and of the circles."""
RING = 4
"""Floats of a circle: centre and radius."""
CANDIDATE = 3
"""Numbers of a candidate pair of features; the first is not 0."""
