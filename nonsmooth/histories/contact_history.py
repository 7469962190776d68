"""What one contact bears over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import TYPE_CHECKING, final

import numpy as np

from nonsmooth.datasets import Told, dataset
from nonsmooth.histories.arrays import Floats, Integers
from nonsmooth.histories.times import of_one, spoken

if TYPE_CHECKING:
    import xarray

    from nonsmooth.histories.contact_forces import ContactForces

_BORNE: Told = {
    "normal_force": ((), "N", "normal force"),
    "friction_force": (("axis",), "N", "friction on the second body"),
    "friction_moment": (("axis",), "N m", "moment of traction on the second body"),
}
_SEEN: Told = {
    "gap": ((), "m", "gap"),
    "points": (("body", "axis"), "m", "points of contact on the first and the second body"),
    "normal": (("axis",), "1", "normal from the first body to the second"),
    "slip_velocity": (("axis",), "m/s", "velocity of the second body over the first"),
}
_SIZES = {"body": 2, "axis": 3}
_TOLD: Told = {"mode": ((), "1", "0 open, 1 stick, 2 slide"), **_BORNE, **_SEEN}


@final
@dataclass(frozen=True, eq=False)
class ContactHistory:
    """One contact over time, as :class:`~nonsmooth.histories.contact_forces.ContactForces` tells of it.

    Of a single time the arrays lack the axis n.

    Attributes
    ----------
    time : array
        [s], shape [n].
    mode : array
        0 open, 1 stick, 2 slide, shape [n].
    normal_force, friction_force, friction_moment : array
        [N], [N] and [N m], zero where it is open; shapes [n], [n, 3] and [n, 3].
    gap, points, normal, slip_velocity : array
        [m], [m], [1] and [m/s], not a number where it is open; shapes [n], [n, 2, 3], [n, 3] and [n, 3].
    contact : str
        Name of the contact.
    """

    time: Floats
    mode: Integers
    normal_force: Floats
    friction_force: Floats
    friction_moment: Floats
    gap: Floats
    points: Floats
    normal: Floats
    slip_velocity: Floats
    contact: str

    def __repr__(self) -> str:
        """Return of which times it is, and how much there is of it."""
        return (
            f"ContactHistory({spoken(self.time)}; largest normal force {np.max(self.normal_force, initial=0.0):.6g} N)"
        )

    def to_xarray(self) -> xarray.Dataset:
        """Return it as a dataset with units."""
        return dataset(self, self.time, _TOLD, contact=self.contact)

    @classmethod
    def spread(cls, forces: ContactForces, entries: Integers, times: Integers, contact: str) -> ContactHistory:
        """Return the history that has some entries at the numbers of times given, and is open at the others."""
        time = np.atleast_1d(forces.time)
        mode = np.zeros(len(time), dtype=np.int64)
        mode[times] = forces.mode[entries]
        arrays = {}
        for names, open_ in ((_BORNE, 0.0), (_SEEN, np.nan)):
            for name in names:
                values = getattr(forces, name)
                arrays[name] = np.full((len(time), *values.shape[1:]), open_)
                arrays[name][times] = values[entries]
        found = cls(time, mode, **arrays, contact=contact)
        return found if forces.time.ndim else of_one(found)


def contacts_dataset(histories: Sequence[ContactHistory], time: Floats) -> xarray.Dataset:
    """Return the histories of some contacts at the same times as one dataset with names and units."""
    told = {name: (("contact", *axes), unit, words) for name, (axes, unit, words) in _TOLD.items()}
    stacked = {
        name: np.stack([getattr(one, name) for one in histories], axis=time.ndim)
        if histories
        else np.zeros((*time.shape, 0, *(_SIZES[axis] for axis in axes)))
        for name, (axes, _, _) in _TOLD.items()
    }
    return dataset(SimpleNamespace(**stacked), time, told, {"contact": [one.contact for one in histories]})
