"""Powers of integers."""

from __future__ import annotations

from nonsmooth.engine.native.kernel import kernel


@kernel("i8(i8, i8)")
def power(base: int, exponent: int) -> int:
    """Power of an integer; 1 for an exponent of 0 or less.

    The operator ``**`` of numba may raise an error. An entry point that may raise one needs functions of numba, which
    would then be imported at every start.
    """
    result = 1
    for _ in range(exponent):
        result *= base
    return result
