"""Basin stability: the share of starts that lead to an attractor."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from nonsmooth.errors import InvalidInput
from nonsmooth.studies.attractors.labels import words_of

if TYPE_CHECKING:
    import xarray


def basin_stability(attractor: xarray.DataArray) -> dict[str, tuple[float, float]]:
    """Return of each attractor the share b of the starts that lead to it, and its standard error sqrt(b (1 - b) / N).

    Parameters
    ----------
    attractor : DataArray
        The attractors of a study whose starts were drawn from the volume that is asked about; N counts the runs that
        came to their end.

    Raises
    ------
    InvalidInput
        If it is no record of words, or no run came to its end.

    References
    ----------
    P. J. Menck, J. Heitzig, N. Marwan, J. Kurths, "How basin stability complements the linear-stability paradigm",
    Nature Physics 9 (2013) 89-92.
    """
    words, values = words_of(attractor, "basin_stability"), attractor.values.ravel()
    n = int((values >= 0).sum())
    if n == 0:
        raise InvalidInput("basin_stability", "needs runs that came to their end", n, "See `status` and `reason`.")
    shares = {word: float((values == i).sum()) / n for i, word in enumerate(words)}
    return {word: (b, math.sqrt(b * (1.0 - b) / n)) for word, b in shares.items()}
