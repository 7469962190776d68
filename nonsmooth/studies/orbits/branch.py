"""A branch: orbits along a parameter, and what happens to them there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.studies.orbits.margins import Margins
from nonsmooth.studies.orbits.periodic import Orbit

Floats = NDArray[np.float64]


@final
@dataclass(frozen=True)
class Special:
    """Where something happens to an orbit.

    Attributes
    ----------
    kind : str
        "fold", "period doubling", "Neimark-Sacker"; where the branch ends as events change "grazing", "corner" where
        two impacts come to be at once, or "sequence" for all others.
    value : float
        The parameter there; where events change for another reason than the two, that of the last orbit.
    orbit : Orbit
        The orbit there, the last one of its events where these change.
    """

    kind: str
    value: float
    orbit: Orbit


@final
@dataclass(frozen=True)
class Branch:
    """Orbits along a parameter.

    Attributes
    ----------
    name : str
        The parameter.
    values : array
        Its values, shape [n].
    orbits : tuple of Orbit
        The orbits.
    margins : tuple of Margins
        How far each is from grazing, and from two impacts at once.
    special : tuple of Special
        What happens on the way.
    ending : str
        Why it ended.
    """

    name: str
    values: Floats
    orbits: tuple[Orbit, ...]
    margins: tuple[Margins, ...]
    special: tuple[Special, ...]
    ending: str
