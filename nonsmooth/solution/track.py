"""Track: the states that a run stored, whole, from which it is known at any time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces import Engine


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
    engine : Engine
        What integrated the run, with its tolerances.
    """

    time: NDArray[np.float64]
    y: NDArray[np.float64]
    booked: NDArray[np.float64]
    engine: Engine
