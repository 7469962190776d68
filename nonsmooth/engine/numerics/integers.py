"""Powers of integers."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import kernel


@kernel("i8(i8, i8)")
def power(base: int, exponent: int) -> int:
    """Power of an integer; 1 for an exponent of 0 or less.

    It replaces the operator ``**``, because numba's version of this operator contains code that raises an error.
    Machine code that can raise an error needs functions of numba.  So every start of a program would import numba.
    """
    result = 1
    for _ in range(exponent):
        result *= base
    return result
