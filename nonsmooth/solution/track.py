"""Track: the states that a run stored, whole, from which it is known at any time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from nonsmooth.model.options import Options


@final
@dataclass(frozen=True, eq=False)
class Track:
    """The states at the samples and at the end of a run; those at events are with the events.

    Attributes
    ----------
    time : array
        [s], shape [n].
    y : array
        All that is integrated: coordinates, velocities, energies, inner states of laws; shape [n, n_y].
    booked : array
        Energies booked in events until then [J]: work of driven bodies, losses by restitution, friction and closing,
        shape [n, 4].
    options : Options
        Tolerances of the run.
    """

    time: NDArray[np.float64]
    y: NDArray[np.float64]
    booked: NDArray[np.float64]
    options: Options
