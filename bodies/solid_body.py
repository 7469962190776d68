"""SolidBody: base class of bodies that are one shape, filled with matter of even density."""

from __future__ import annotations

from abc import abstractmethod
from typing import final

from nonsmooth.interfaces import ConvexShape, Shape

from .free import FreeBody
from .inertia import mass_of
from .shapes.triangle_mesh import TriangleMesh


class SolidBody(FreeBody):
    """A free body that fills one shape evenly.

    Subclasses are final frozen dataclasses with the fields ``density`` and ``mass``
    (:func:`bodies.inertia.density_field`, :func:`bodies.inertia.mass_field`). They give ``centred_shape`` and their
    inertia.
    """

    @property
    @abstractmethod
    def density(self) -> float | None:
        """Density [kg/m^3]; that of steel, 7800, if neither density nor mass is given."""

    @property
    @abstractmethod
    def mass(self) -> float | None:
        """Mass [kg], if it is given instead of the density."""

    @property
    @abstractmethod
    def centred_shape(self) -> ConvexShape | TriangleMesh:
        """The shape, with its centroid at the origin of the frame."""

    @property
    @final
    def total_mass(self) -> float:
        """Mass as given, or density times the volume of the shape [kg]."""
        return mass_of(self, self.mass, self.density, self.centred_shape.volume)

    @property
    @final
    def shapes(self) -> tuple[Shape, ...]:
        """The only shape of the body, with the mass centre at the origin of the frame; a tuple of one."""
        return (self.centred_shape,)
