"""The engine's memory: one table of scalars, one of float arrays, one of integer arrays.

Everything that the engine knows stands in one record ``S`` of scalars and two heaps.  An entry of
``S`` named after an array holds the offset of that array in its heap, so ``w[S.gap_rate + c]`` is the gap
rate of contact ``c`` and ``k[S.mode + c]`` its mode.  All sizes are run-time counts: another number of
bodies or contacts is another set of offsets, never another compilation.

What plug-ins write stands in blocks of their own (:mod:`nonsmooth.engine.memory.blocks`).

Bodies tied by joints form an articulation, every other body is an articulation of its own; the bodies of one stand next
to each other.
"""

from __future__ import annotations

from nonsmooth.engine.memory import tableau

CATALOGUE = (
    "body_a",
    "body_b",
    "frame_a",
    "frame_b",
    "nu_a",
    "nu_b",
    "shift_a",
    "shift_b",
    "articulation_a",
    "articulation_b",
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
    "pair",
    "mode",
    "averaged",
)
"""Integers of a declared contact; in a slot each of them is an array of its own."""
CONTACT_TIME, DIRECTION, REACH, CLOSING_RATE, LEVERS, SIZE = 0, 1, 3, 4, 5, 7
"""Where these floats of a declared contact stand: slip direction, levers of both bodies, size of the smaller one."""
MOBILITY, SMALL_FORCE, MEAN_FORCE, MEAN_SPAN, MEAN_WAY, MEAN_GAP, MEAN_ASKED, MEAN_WAIT = 8, 9, 10, 13, 14, 15, 16, 17
"""And those that its last event left of it: how fast it slips under a unit of friction, what counts as no force, and
of averaged forces what they are, how long they are, on what way the gap comes to rest, where it began, when those of
the instant were asked for last, and after how long they are again."""
REVOLUTION = 18
"""Axis of the shape with the smaller lever, in its frame, about which it may spin."""
CATALOGUE_FLOATS = 21
"""How many they are."""
PARTS = 48
"""Halvings of a step in search of a gap that closes, or of an event: as many as its fractions can be told apart."""
PART_END = 7
"""Floats of an end of a part of a step."""
ORIENTED = 7
"""Numbers of an anisotropic law: side of the body, its axis, friction forward, backward and across."""
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
TOTALS = 9
"""Floats of a contact that go from one window of a large impact to the next."""
