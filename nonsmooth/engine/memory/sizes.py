"""Sizes: how long an array is, as a function of the counts of a system."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeAlias

from nonsmooth.engine.memory.blocks import DELASSUS, GUARD
from nonsmooth.engine.memory.layout import BOOKED, MOST_BLOCKS, MOST_ENTRIES, PART_END, PARTS

Counts: TypeAlias = Mapping[str, int]
Size: TypeAlias = Callable[[Counts], int]


def per(stride: int, count: str) -> Size:
    """Size of ``stride`` numbers for each of what is counted."""
    return lambda n: stride * n[count]


def fixed(length: int) -> Size:
    """Size that is the same in all systems."""
    return lambda n: length


def ends(count: str) -> Size:
    """Size of a list of starts and the end of the last."""
    return lambda n: n[count] + 1


def matrix_entries(n: Counts) -> int:
    """Length of a matrix of all unknowns of the contacts."""
    return int(min((3 * n["n_slots"]) ** 2, MOST_ENTRIES))


def delassus_blocks(n: Counts) -> int:
    """Number of pairs of contacts that may act on one another."""
    return int(min(n["n_slots"] ** 2, MOST_BLOCKS))


def delassus_numbers(n: Counts) -> int:
    """Length of the Delassus blocks."""
    return DELASSUS * delassus_blocks(n)


def all_guards(n: Counts) -> int:
    """Number of guards: three for each contact, and those of the user."""
    return 3 * n["n_slots"] + n["n_own_guards"]


def coordinates_and_velocities(n: Counts) -> int:
    """Number of coordinates and velocities of all bodies."""
    return n["n_q"] + n["n_u"]


def spans(n: Counts) -> int:
    """Largest number of spans of the state: coordinates and velocities of each body, and the accounts."""
    return 2 * n["n_bodies"] + 1


def step_part_numbers(n: Counts) -> int:
    """Length of the list of ends of parts of a step."""
    return PART_END * (PARTS + 1)


def impulse_numbers(n: Counts) -> int:
    """Length of the impulses of all contacts, with the numbers behind that a law must not change."""
    return 3 * n["n_slots"] + GUARD


def map_numbers(n: Counts) -> int:
    """Length of what an impact law that maps velocities is given."""
    return n["map_width"] * n["n_slots"]


def lemke_columns(n: Counts) -> int:
    """Number of columns of Lemke's method, the artificial one among them."""
    return 6 * n["n_pivoted"] + 1


def lemke_numbers(n: Counts) -> int:
    """Length of the tableau of Lemke's method."""
    return 6 * n["n_pivoted"] * (6 * n["n_pivoted"] + 2)


def sample_numbers(n: Counts) -> int:
    """Length of the buffer of samples."""
    return n["sample_capacity"] * (1 + n["n_y"] + BOOKED)
