"""Sizes: the number of entries of an array, as a function of the counts of a system."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeAlias

from nonsmooth.engine.memory.blocks import DELASSUS, GUARD
from nonsmooth.engine.memory.layout import BOOKED, JACOBIANS, MOST_BLOCKS, MOST_ENTRIES, PART_END, PARTS

Counts: TypeAlias = Mapping[str, int]
Size: TypeAlias = Callable[[Counts], int]


def per(stride: int, count: str) -> Size:
    """Size of an array of ``stride`` numbers for each counted thing. ``per(3, "n_slots")``: 3 per active contact."""
    return lambda n: stride * n[count]


def fixed(length: int) -> Size:
    """Size of an array that has the same length in all systems."""
    return lambda n: length


def ends(count: str) -> Size:
    """Size of a list of the starts of ranges, one for each counted thing, with the end of the last range."""
    return lambda n: n[count] + 1


def matrix_entries(n: Counts) -> int:
    """Number of entries allocated for a matrix of a contact problem: full for three unknowns per contact.

    At most ``MOST_ENTRIES``, because a full matrix of a large system would not fit into memory. A larger problem is
    stored as a band; if that has too many entries, too, the run ends with the status ``NO_SLOT``.
    """
    return int(min((3 * n["n_slots"]) ** 2, MOST_ENTRIES))


def delassus_blocks(n: Counts) -> int:
    """Number of Delassus blocks that are allocated, one for each ordered pair of contacts, at most ``MOST_BLOCKS``.

    In a large system most pairs do not act on one another, and need none. If more blocks are needed, the run ends with
    the status ``NO_SLOT``.
    """
    return int(min(n["n_slots"] ** 2, MOST_BLOCKS))


def delassus_numbers(n: Counts) -> int:
    """Number of floats of all Delassus blocks."""
    return DELASSUS * delassus_blocks(n)


def all_guards(n: Counts) -> int:
    """Number of guards, functions whose roots are events: three for each active contact, and those of the user.

    Those of a contact are its normal guard, its friction guard, and that of the end of its features.
    """
    return 3 * n["n_slots"] + n["n_own_guards"]


def jacobian_numbers(n: Counts) -> int:
    """Number of floats of the Jacobians of all active contacts, and of their responses.

    Each has one of both for either of its bodies: three rows over the velocities of an articulation.
    """
    return JACOBIANS * 3 * n["most_velocities"] * n["n_slots"]


def history_entries(n: Counts) -> int:
    """Number of places of the hash table of histories: twice as many as there are histories, so that few collide."""
    return 2 * n["n_slots"] + 1


def coordinates_and_velocities(n: Counts) -> int:
    """Number of coordinates and velocities of all bodies."""
    return n["n_q"] + n["n_u"]


def spans(n: Counts) -> int:
    """Largest number of spans, the ranges of the state that a step integrates."""
    # coordinates of each body, velocities of each body; accounts and inner states
    return 2 * n["n_bodies"] + 1


def step_part_numbers(n: Counts) -> int:
    """Number of floats of the list of ends of the parts into which a step is halved in search of a root.

    At most ``PARTS`` parts, side by side, are listed at once; they have one end more.
    """
    return PART_END * (PARTS + 1)


def impulse_numbers(n: Counts) -> int:
    """Number of impulses of all contacts, and of the marks behind them, which show if a law has written too many."""
    return 3 * n["n_slots"] + GUARD


def map_numbers(n: Counts) -> int:
    """Number of floats that an impact map reads: the friction coefficient and the parameters of each contact."""
    return n["map_width"] * n["n_slots"]


def lemke_columns(n: Counts) -> int:
    """Number of variables in the columns of Lemke's tableau: six for each contact, and the artificial variable.

    The six are four corners of a polygon in place of the friction disc, the normal force, and the slip acceleration.
    """
    return 6 * n["n_pivoted"] + 1


def lemke_numbers(n: Counts) -> int:
    """Number of entries of Lemke's tableau, with six rows for each contact."""
    # columns: those of the variables (:func:`lemke_columns`), and the right-hand side
    return 6 * n["n_pivoted"] * (6 * n["n_pivoted"] + 2)


def sample_numbers(n: Counts) -> int:
    """Number of floats of the buffer of samples. A sample is time, state, and the energies accounted at instants."""
    return n["sample_capacity"] * (1 + n["n_y"] + BOOKED)
