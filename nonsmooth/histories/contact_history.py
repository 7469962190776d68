"""What one contact bears over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np

from nonsmooth.histories.arrays import Floats, Integers
from nonsmooth.histories.times import of_one, spoken

if TYPE_CHECKING:
    import xarray

    from nonsmooth.histories.contact_forces import ContactForces

_BORNE = {
    "normal_force": ("N", "normal force"),
    "friction_force": ("N", "friction on the second body"),
    "friction_moment": ("N m", "moment of traction on the second body"),
}
_SEEN = {
    "gap": ("m", "gap"),
    "points": ("m", "points of contact on the first and the second body"),
    "normal": ("1", "normal from the first body to the second"),
    "slip_velocity": ("m/s", "velocity of the second body over the first"),
}
_AXES = ("time", "contact", "body", "axis")


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

    def __repr__(self) -> str:
        """Return of which times it is, and how much there is of it."""
        return (
            f"ContactHistory({spoken(self.time)}; largest normal force {np.max(self.normal_force, initial=0.0):.6g} N)"
        )

    @classmethod
    def spread(cls, forces: ContactForces, entries: Integers, times: Integers) -> ContactHistory:
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
        found = cls(time, mode, **arrays)
        return found if forces.time.ndim else of_one(found)


def dataset(forces: ContactForces, numbers: Sequence[int]) -> xarray.Dataset:
    """Return the histories of some contacts as one dataset with units."""
    import xarray

    time, histories = np.atleast_1d(forces.time), [forces.history(number) for number in numbers]
    mode = np.zeros((len(time), len(numbers)), dtype=np.int64)
    for i, history in enumerate(histories):
        mode[:, i] = history.mode
    variables: dict[str, tuple[tuple[str, ...], Floats | Integers, dict[str, str]]] = {}
    variables["mode"] = _AXES[:2], mode, {"long_name": "0 open, 1 stick, 2 slide"}
    for name, (units, words) in (_BORNE | _SEEN).items():
        values = np.zeros((len(time), len(numbers), *getattr(forces, name).shape[1:]))
        for i, history in enumerate(histories):
            values[:, i] = getattr(history, name)
        axes = _AXES[:2] + _AXES[6 - values.ndim :]
        variables[name] = axes, values, {"units": units, "long_name": words}
    coordinates = {"time": ("time", time, {"units": "s"}), "contact": ("contact", numbers)}
    return xarray.Dataset(variables, coords=coordinates | {"axis": ["x", "y", "z"], "body": ["first", "second"]})
