"""Powers of integers."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import kernel


@kernel("i8(i8, i8)")
def power(base: int, exponent: int) -> int:
    """Power of an integer; 1 for an exponent of 0 or less.

    It replaces the operator ``**``, which may raise an error in code that numba compiles.  Machine code that may raise
    an error needs functions of numba, so that numba would be imported whenever a program starts.
    """
    result = 1
    for _ in range(exponent):
        result *= base
    return result
