"""Numbers that size the workspace: stages, accounts, limits of what is coupled."""

from __future__ import annotations

from nonsmooth.engine.memory import tableau

PARTS = 48
"""Halvings of a step in search of a gap that closes, or of an event: as many as its fractions can be told apart."""
PART_END = 7
"""Floats of an end of a part of a step."""
DRIVEN, FRICTION_LOSS, EXCHANGED, LOADS = 0, 1, 2, 3
"""Which of the accounts is which."""
N_ACCOUNTS = 4
"""Energies integrated with the state: work of driven bodies, loss to friction, gross exchange, work of loads."""
BOOKED = 4
"""Energies booked at instants and projections: work of driven bodies, losses by restitution, friction and closing."""
MOST_BLOCKS = 2**22
"""Pairs of contacts that act on one another, of which a system has room for all up to so many."""
MOST_ENTRIES = 2**26
"""Entries of a matrix of the contacts' unknowns, of which there is room for all up to so many."""
N_STAGES = len(tableau.NODES)
"""Stages of the Runge-Kutta pair;"""
LAST_STAGE = N_STAGES - 1
"""the slope of the last one is that at the end of the step."""
NORMAL_ROW, FIRST_ROW, SECOND_ROW = 0, 1, 2
"""Rows of a contact: along the normal and along the two tangents."""
IMPULSE, DEFORMATION, WORK, DISSIPATED, ENERGY, LOST = 0, 3, 4, 5, 6, 7
"""Where the numbers of a contact begin in the state of an impact."""
IMPACT_STATE = 8
"""Floats of a contact in the state of an impact."""
IMPACT_GUARDS = 3
"""Guards of a contact within an impact."""
