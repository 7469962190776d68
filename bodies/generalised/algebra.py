"""Small dense linear algebra for evaluators: rows of a matrix times a vector, and the inverse of a mass matrix."""

from __future__ import annotations

import math

from nonsmooth.compiled import compiled
from nonsmooth.types import Floats


@compiled
def clear(n: int, out: Floats) -> None:
    """Write n zeros."""
    for i in range(n):
        out[i] = 0.0


@compiled
def multiply(rows: int, n: int, matrix: Floats, vector: Floats, out: Floats) -> None:
    """Write matrix times vector; the matrix has ``rows`` rows of n."""
    for i in range(rows):
        total = 0.0
        for j in range(n):
            total += matrix[i * n + j] * vector[j]
        out[i] = total


@compiled
def quadratic(n: int, matrix: Floats, vector: Floats) -> float:
    """Return vector . matrix vector / 2."""
    total = 0.0
    for i in range(n):
        for j in range(n):
            total += matrix[i * n + j] * vector[i] * vector[j]
    return 0.5 * total


@compiled
def invert(n: int, matrix: Floats) -> None:
    """Put the inverse of a symmetric positive definite matrix in its place, by Cholesky.

    Of the matrix only the lower triangle is read.  If it is not positive definite, what comes out is not finite.
    """
    for j in range(n):
        pivot = matrix[j * n + j]
        for m in range(j):
            pivot -= matrix[j * n + m] * matrix[j * n + m]
        matrix[j * n + j] = math.sqrt(pivot) if pivot > 0.0 else math.nan
        for i in range(j + 1, n):
            total = matrix[i * n + j]
            for m in range(j):
                total -= matrix[i * n + m] * matrix[j * n + m]
            matrix[i * n + j] = total / matrix[j * n + j]
    # the factor L gives way to its inverse, column by column ...
    for j in range(n):
        matrix[j * n + j] = 1.0 / matrix[j * n + j]
        for i in range(j + 1, n):
            total = 0.0
            for m in range(j, i):
                total -= matrix[i * n + m] * matrix[m * n + j]
            matrix[i * n + j] = total / matrix[i * n + i]
    # ... and that to L^-T L^-1, of which row i needs no row above
    for i in range(n):
        for j in range(i + 1):
            total = 0.0
            for m in range(i, n):
                total += matrix[m * n + i] * matrix[m * n + j]
            matrix[i * n + j] = total
            matrix[j * n + i] = total
