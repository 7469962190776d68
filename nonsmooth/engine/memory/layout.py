"""Constants that size the workspace, such as numbers of stages and accounts.

Compiled code and the Python code that allocates and reads the workspace share them.
"""

from __future__ import annotations

from nonsmooth.engine.memory import tableau

PARTS = 48
"""Largest number of halvings of a step in search of a root. More would give fractions that differ by round-off only."""
PART_END = 7
"""Number of floats that a search for the closing of a gap stores for a time within a step.

They are the fraction of the step [1], the gap [m], its rate [m/s], the distance past the ends of the features [m], and
the offset of the witness point from the frame's origin [m], shape [3].
"""
DRIVEN, FRICTION_LOSS, EXCHANGED, LOADS, CLOSING_LOSS = 0, 1, 2, 3, 4
"""Positions of the energies integrated with the state [J].

They are the work of driven bodies, the loss by friction, the energy exchanged (integral of the absolute values of all
powers, to which round-off is relative), the work of loads, and the loss by normal forces of the time-stepping fallback.
"""
N_ACCOUNTS = 5
"""Number of energies that are integrated with the state."""
BOOKED = 4
"""Number of energies accounted at instants: work of driven bodies, losses by restitution, friction and closing."""
JACOBIANS = 4
"""Number of Jacobians and responses of a contact: one of both for either of its bodies."""
MOST_BLOCKS = 2**22
"""Most Delassus blocks that are allocated, 0.3 GB. Smaller systems have one for each pair of contacts."""
MOST_ENTRIES = 2**26
"""Most entries of a matrix of unknowns that are allocated, 0.5 GB. Smaller systems have a full matrix."""
N_STAGES = len(tableau.NODES)
"""Number of stages of both Runge-Kutta pairs."""
LAST_STAGE = N_STAGES - 1
"""Number of the last stage of both Runge-Kutta pairs. This stage evaluates the derivative at the end of the step."""
NORMAL_ROW, FIRST_ROW, SECOND_ROW = 0, 1, 2
"""Rows of a contact: along the normal and along the two tangents."""
IMPULSE, DEFORMATION, WORK, DISSIPATED, ENERGY, LOST = 0, 3, 4, 5, 6, 7
"""Offsets of the numbers of a contact in the state of an impact.

They are those of three impulses [N s], deformation [m], work of the normal force, energy dissipated by friction, stored
energy, and the part of it that is lost when the contact opens [J].
"""
IMPACT_STATE = 8
"""Number of floats of a contact in the state of an impact."""
IMPACT_GUARDS = 3
"""Number of guards of a contact within an impact: rate, energy and friction."""
SINGULAR = 1e-10
"""Size of a pivot or of a remaining column, relative to the largest one, up to which it is treated as zero."""
NO_PAIR = -1
"""Index of the checked pair of shapes of a contact, if the overlap of its shapes is not checked."""
MOST_POINTS = 200
"""Most points of the polytope that proves the depth of an overlap. Concentric balls end with an error of 1 %."""
MOST_FACES = 2 * MOST_POINTS
"""Most faces of that polytope: a closed surface of triangles has twice as many faces as points, less four."""
