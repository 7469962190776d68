"""Eigenvalues of a matrix that is known but for errors."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def eigenvalues(matrix: Floats, error: Floats) -> tuple[NDArray[np.complex128], Floats]:
    """Return the eigenvalues, the largest first, and bounds of their errors, shape [m] each.

    Gershgorin's circles of the matrix in the basis of its eigenvectors V hold the eigenvalues of every matrix within
    the errors E; their radii are the row sums of abs(V^-1) E abs(V).  They grow beyond all bounds where two
    eigenvalues meet.  There the bound of Elsner (1985) is smaller: (2 |M| + |E|)^(1 - 1/m) |E|^(1/m).

    Parameters
    ----------
    matrix : array
        The matrix, shape [m, m].
    error : array
        Bounds of the errors of its numbers, shape [m, m].
    """
    m = len(matrix)
    if m == 0:
        return np.zeros(0, dtype=complex), np.zeros(0)
    found, vectors = np.linalg.eig(matrix)
    order = np.argsort(-np.abs(found), kind="stable")
    found, vectors = found[order].astype(complex), vectors[:, order]
    if not np.all(np.isfinite(error)):
        return found, np.full(m, np.inf)
    largest = float(np.linalg.norm(error))
    elsner = (2.0 * float(np.linalg.norm(matrix, 2)) + largest) ** (1.0 - 1.0 / m) * largest ** (1.0 / m)
    try:
        radii = np.sum(np.abs(np.linalg.inv(vectors)) @ error @ np.abs(vectors), axis=1)
    except np.linalg.LinAlgError:
        return found, np.full(m, elsner)
    return found, np.minimum(radii, elsner)


def with_error(value: complex, error: float) -> str:
    """Return an eigenvalue with its error, "0.5 (+-2e-11)"."""
    return f"{value:.8g} (+-{error:.0e})"
