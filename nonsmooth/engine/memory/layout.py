"""The engine's memory: one table of scalars, one of float arrays, one of integer arrays.

Everything that the engine knows stands in one record ``S`` of scalars and two heaps.  An entry of
``S`` named after an array holds the offset of that array in its heap, so ``w[S.gap + c]`` is the gap
of contact ``c`` and ``k[S.mode + c]`` its mode.  All sizes are run-time counts: another number of
bodies or contacts is another set of offsets, never another compilation.

Every body owns an output block, written by its ``evaluate`` function, with the parts below in this
order.  The parts down to the Jacobian belong to a frame and are repeated for every frame of the body; :data:`FRAME`
floats of frame motion are all that a driven body writes.

======================  ===============  =======================================================
part                    size             meaning
======================  ===============  =======================================================
position                3                origin of the body frame [m]
rotation                9                body axes as columns, row by row
velocity                3                of the origin [m/s]
angular velocity        3                in world axes [rad/s]
acceleration bias       3                of the origin while u' = 0 [m/s^2]
angular bias            3                in world axes while u' = 0 [rad/s^2]
jacobian                6 n_u            of (velocity, angular velocity) with respect to u
coordinate rates        n_q              dq/dt = B u
force                   n_u              h of M u' = h + W lambda_N + N lambda_T
inverse mass            n_u n_u          M^-1
energy                  2                kinetic and potential [J]
======================  ===============  =======================================================

The geometry block of a contact holds gap, normal (from the first body to the second), first
tangent, witness points on both bodies and, for either surface, the matrices ``slide`` and ``turn`` of
``slide @ u = turn @ nu``: the witness sliding at u over the body turns the normal by nu (both in the
tangent plane; they commute).  A sphere of radius r has slide 1, turn r; a plane slide 0, turn 1; a vertex slide 1,
turn 0.  A point contact needs a curved or sharp side: two planes have none.  Then comes the number of the pair of
features that are in contact, out of the kinematics' ``features``, and last how far the witness points are past the
ends of features that end, such as edges and the faces of a polyhedron [m]: negative within, 0 where nothing ends.  Past
an end the gap is a number that no rate belongs to, positive unless the bodies overlap, and a closed contact opens.

A joint writes :data:`JOINT_ROW` floats per row: residual [m or 1], axis and moment, a point on either body, bias.
The row's rate is axis . (velocity of the second body at its point - of the first at its own) + moment . (difference
of the angular velocities); the bias is its derivative while u' = 0.

A load writes force [N] on the second body, the point where it acts [m], and moment [N m]; the first body gets the
opposite.

Bodies tied by joints form a linkage, every other body is a linkage of its own; its bodies stand next to each other.
"""

from __future__ import annotations

from nonsmooth.engine.memory import tableau

FRAME = 24
"""Floats of frame motion at the head of a body's output block."""
GUARD = 8
"""Floats behind each block that a plug-in writes: one that writes past its block is found by them."""
UNTOUCHED = 1.2345678901234567e-89
"""What stands there."""
FEATURE, PAST_END = 29, 30
"""Where in a geometry block stand the number of the features in contact and how far the contact is past their end."""
PAIR = 31
"""Floats of a geometry block that a kinematics writes."""
GEOMETRY = PAIR + GUARD
"""Floats of a contact's geometry block."""
JOINT_ROW = 14
"""Floats of one row of a joint."""
LOAD = 9
"""Floats that a load writes."""
FORCE_AND_MOMENT = 5
"""Floats that a law of traction writes before the rates of its states."""
CATALOGUE = (
    "body_a",
    "body_b",
    "frame_a",
    "frame_b",
    "nu_a",
    "nu_b",
    "shift_a",
    "shift_b",
    "linkage_a",
    "linkage_b",
    "geometry_function",
    "geometry_parameters",
    "friction_function",
    "friction_parameters",
    "force_function",
    "force_parameters",
    "efficiency_function",
    "efficiency_parameters",
    "map_parameters",
    "normal_function",
    "normal_parameters",
    "traction_function",
    "traction_parameters",
    "traction_out",
    "rates_function",
    "rates_parameters",
    "rates_out",
    "state",
    "n_state",
    "state_start",
    "state_copy",
    "oriented",
    "axis",
    "candidate",
    "mode",
)
"""Integers of a declared contact; in a slot each of them is an array of its own."""
CANDIDATE = 3
"""Numbers of a pair of features in a pool; the first is not 0."""
CATALOGUE_FLOATS = 8
"""Floats of a contact: contact time, slip direction, reach, rate at which it closed, levers, size of the smaller."""
SECTORS = 48
"""Halvings of a step in search of a gap that closes: as many as its fractions can be told apart."""
SECTOR = 7
"""Floats of an end of a part of a step: fraction, gap, gap rate, how far past the end of the features, witness arm."""
FALL = 3
"""Floats of how fast the rate of a gap can fall: now, by how much more each second, and the turning [rad/s]."""
ORIENTED = 7
"""Numbers of an anisotropic law: side of the body, its axis, friction forward, backward and across."""
N_ACCOUNTS = 4
"""Energies integrated with the state: work of driven bodies, loss to friction, gross exchange, work of loads."""
MOST_BLOCKS = 2**22
"""Pairs of contacts that act on one another, of which a system has room for all up to so many."""
MOST_ENTRIES = 2**26
"""Entries of a matrix of the contacts' unknowns, of which there is room for all up to so many."""
STIFF = 8
"""Contacts of an impact, at most, whose stiff slips are integrated implicitly."""
N_STAGES = len(tableau.NODES)
"""Stages of the Runge-Kutta pair."""
TOTALS = 9
"""Floats of a contact that go from one window of a large impact to the next."""
