"""Arrays among the floats of the workspace: copies, sums, largest entry. ``a`` and ``out`` are offsets."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import Floats, kernel


@kernel("void(F, i8, i8, i8)")
def copy_numbers(floats: Floats, a: int, n: int, out: int) -> None:
    """Copy ``n`` floats of the workspace from the offset ``a`` to the offset ``out``."""
    for i in range(n):
        floats[out + i] = floats[a + i]


@kernel("void(F, i8, i8)")
def clear(floats: Floats, a: int, n: int) -> None:
    """Set the ``n`` floats of the workspace at the offset ``a`` to zero."""
    for i in range(n):
        floats[a + i] = 0.0


@kernel("f8(F, i8, i8)")
def largest_size(floats: Floats, a: int, n: int) -> float:
    """Largest absolute value of the ``n`` floats of the workspace at the offset ``a``; 0 if there are none.

    Numbers that are nan are passed over.
    """
    largest = 0.0
    for i in range(n):
        # of a number and nan, this order of the arguments gives the number
        largest = max(largest, abs(floats[a + i]))
    return largest


@kernel("void(F, i8, f8, i8, i8)")
def subtract_part(floats: Floats, out: int, part: float, a: int, n: int) -> None:
    """Subtract ``part`` times the vector of ``n`` floats at the offset ``a`` from that at ``out``, in place.

    A negative ``part`` adds a multiple.
    """
    for i in range(n):
        floats[out + i] -= part * floats[a + i]
