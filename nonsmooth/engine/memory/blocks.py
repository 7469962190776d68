"""What plug-ins write: the blocks of bodies, contacts, joints and loads, and where in them everything stands.

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
pair of features that are in contact, out of the kinematics' ``features``, and last, at ``PAST_END``, how far the
witness points are past the ends of features that end, such as edges and the faces of a polyhedron [m]: negative within,
0 where nothing ends.  Past an end the gap is a number that no rate belongs to, positive unless the bodies overlap, and
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
"""Where the parts of a frame begin."""
FRAME = JACOBIAN
"""Floats of frame motion at the head of a body's output block."""
GAP, NORMAL, TANGENT, POINT_A, POINT_B, SIDE_A, SIDE_B, FEATURE, PAST_END = 0, 1, 4, 7, 10, 13, 21, 29, 30
"""Where the parts of a geometry block begin."""
SLIDE_MATRIX, TURN_MATRIX = 0, 4
"""Where the matrices of a surface begin, behind ``SIDE_A`` or ``SIDE_B``; row by row."""
PAIR = 31
"""Floats of a geometry block that a kinematics writes."""
GUARD = 8
"""Floats behind each block that a plug-in writes: one that writes past its block is found by them."""
UNTOUCHED = 1.2345678901234567e-89
"""What stands there."""
GEOMETRY = PAIR + GUARD
"""Floats of a contact's geometry block."""
RESIDUAL, AXIS, MOMENT, ROW_BIAS = 0, 1, 4, 13
"""Where the parts of a joint's row begin, besides ``POINT_A`` and ``POINT_B``."""
JOINT_ROW = 14
"""Floats of one row of a joint."""
FORCE, LOAD_POINT, LOAD_MOMENT = 0, 3, 6
"""Where the parts of what a load writes begin."""
LOAD = 9
"""Floats that a load writes."""
TRACTION, TRACTION_MOMENT = 0, 2
"""Where the force and the moment begin that a law of traction writes."""
FORCE_AND_MOMENT = 5
"""Floats that a law of traction writes before the rates of its states."""
DELASSUS = 9
"""Floats of a block of the Delassus matrix, row by row."""
PART_PLACE, PART_AXES, PART_SEMI, PART_POWERS, PART_BALL, PART_RADIUS = 0, 3, 12, 15, 17, 18
"""Where the numbers of a convex part stand (:class:`nonsmooth.interfaces.ConvexPart`): its origin and axes in the frame
of its body, semi-axes and powers of what is added, the radius of the ball that is, and of one about the origin that
holds it all;"""
PART_FUNCTION, PART_COUNT, PART_RINGS = 19, 20, 21
"""where in them a function stands that gives what is added, 0 for none, how many circles there are, -1 for a half-space
below the origin, and the circles."""
RING = 4
"""Centre and radius of a circle."""
CANDIDATE = 3
"""Numbers of a pair of features in a pool; the first is not 0."""
