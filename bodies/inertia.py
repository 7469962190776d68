"""Inertia tensors: checks of a user's tensor, parallel axes, mass from density."""

from __future__ import annotations

import math
from typing import Any, Protocol

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import parameter

from .values import vector

Triple = tuple[float, float, float]

STEEL = 7800.0
"""Density of a body if neither its mass nor its density is given [kg/m^3]."""

_ROUND_OFF = 1e-9


class HasVolume(Protocol):
    """A shape or mesh that encloses a volume: its integrals at density 1."""

    @property
    def volume(self) -> float:
        """Volume [m^3]."""

    @property
    def inertia(self) -> Vector:
        """Inertia tensor about the centroid at density 1 [m^5], shape [3, 3]."""


def tensor_of(moments: Triple, products: Triple) -> Vector:
    """Return the tensor [kg m^2, shape (3, 3)] of J_xx, J_yy, J_zz and J_yz, J_xz, J_xy."""
    (x, y, z), (yz, xz, xy) = moments, products
    return np.array([[x, xy, xz], [xy, y, yz], [xz, yz, z]])


def read_tensor(thing: str, value: Any) -> Vector:
    """Return an inertia tensor [kg m^2], shape [3, 3], from a tensor or from three principal moments.

    Raises
    ------
    InvalidInput
        The value has another shape, a number that is not finite, or is not symmetric.
    """
    if np.shape(value) == (3,):
        return np.diag(vector(thing, value, 3, "kg m^2"))
    if np.shape(value) != (3, 3):
        raise InvalidInput(thing, "must be three principal moments or a 3 x 3 tensor", value, "Give it in [kg m^2].")
    rows = np.array([vector(thing, row, 3, "kg m^2") for row in value])
    if np.max(np.abs(rows - rows.T)) > _ROUND_OFF * np.max(np.abs(rows)):
        raise InvalidInput(thing, "must be symmetric", rows.tolist(), "J_xy = J_yx = -integral of x y dm, and so on.")
    return np.asarray(0.5 * (rows + rows.T))


def check_inertia(name: str, mass: float, tensor: Vector) -> None:
    """Check what every body with mass obeys.

    Raises
    ------
    InvalidInput
        If the mass is not positive, the tensor not positive definite, or one of its principal moments is larger than
        the sum of the others.
    """
    if not 0.0 < mass < math.inf:
        raise InvalidInput(f"mass of {name}", "must be positive and finite [kg]", mass, "A body that moves has mass.")
    if not np.all(np.isfinite(tensor)):
        raise InvalidInput(f"inertia of {name}", "must be finite", tensor.tolist(), "Give it in [kg m^2].")
    moments = np.linalg.eigvalsh(tensor)
    shown = [float(f"{moment:.9g}") for moment in moments]
    if moments[0] <= 1e-14 * moments[2]:
        raise InvalidInput(
            f"inertia of {name}",
            "must be positive definite",
            tensor.tolist(),
            f"Its principal moments are {shown} [kg m^2]; a body without extent has none. "
            "Give a point mass 1e-8 m l^2 each, with a length l of the system.",
        )
    if moments[2] > (moments[0] + moments[1]) * (1.0 + _ROUND_OFF):
        raise InvalidInput(
            f"inertia of {name}",
            "must have no principal moment larger than the sum of the other two",
            shown,
            "No distribution of mass has such moments; check the axes and the signs of the products.",
        )


def parallel_axis(mass: float, offset: Vector) -> Vector:
    """Return what a mass [kg] adds to the tensor when its centre is at ``offset`` [m] from the origin, shape [3, 3]."""
    return mass * (float(offset @ offset) * np.eye(3) - np.outer(offset, offset))


def density_field(doc: str = "density; 7800 without a mass") -> Any:
    """Declare the density of a body as a parameter that may be left out."""
    return parameter(None, doc=doc, unit="kg/m^3", above=0.0, usual=(10.0, 3e4))


def mass_field(other: str = "density") -> Any:
    """Declare the mass of a body as a parameter that may be left out."""
    return parameter(None, doc=f"mass, instead of the {other}", unit="kg", above=0.0)


def check_mass(body: object, mass: float | None, density: float | None) -> None:
    """Raise InvalidInput if the user gives both mass and density: one of them would be ignored."""
    if mass is not None and density is not None:
        raise InvalidInput(
            f"{type(body).__name__}.mass",
            "must not be given together with the density",
            mass,
            "Give one of the two; the other follows.",
        )


def mass_of(body: object, mass: float | None, density: float | None, volume: float) -> float:
    """Mass of a body [kg]: as given, or density times volume [m^3]; the default density is that of steel."""
    check_mass(body, mass, density)
    if mass is not None:
        return mass
    return (STEEL if density is None else density) * volume


def moments_of(shape: HasVolume, mass: float) -> Triple:
    """Moments of inertia of a mass [kg] spread evenly in a shape, about its centroid and the body axes [kg m^2]."""
    x, y, z = (mass / shape.volume * np.diag(shape.inertia)).tolist()
    return x, y, z


def tensor_in(shape: HasVolume, mass: float) -> Vector:
    """Inertia tensor of a mass [kg] spread evenly in a shape, about its centroid [kg m^2], shape [3, 3]."""
    return without_round_off(mass / shape.volume * shape.inertia)


def without_round_off(tensor: Vector, part: float = 1e-14) -> Vector:
    """Inertia tensor without round-off, which is ``part`` times the largest element.

    Smaller elements are 0, and moments that differ by less are equal. So principal axes remain principal, and a
    symmetric body is recognised.
    """
    least = part * np.max(tensor)
    found = np.where(np.abs(tensor) > least, tensor, 0.0)
    for i, j in ((0, 1), (1, 2), (0, 2)):
        if abs(found[i, i] - found[j, j]) <= least:
            found[j, j] = found[i, i]
    return found
