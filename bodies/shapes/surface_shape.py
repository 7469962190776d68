"""SurfaceShape: base class of shapes whose contacts come from flat faces, convex edges and corners."""

from __future__ import annotations

from abc import abstractmethod

from nonsmooth.interfaces import Shape
from nonsmooth.interfaces.body import Vector

from ..meshes.features import Features


class SurfaceShape(Shape):
    """A surface of flat faces, convex edges and corners, or all points within the radius ``sweep`` of it.

    Boxes, convex hulls and meshes are surfaces.  The core of a rounded one is a surface, too; that of a capsule is a
    segment, which has one edge and no face.
    """

    @property
    @abstractmethod
    def features(self) -> Features:
        """Flat faces, convex edges and corners of the surface, in the body frame; one object for each shape."""

    @property
    @abstractmethod
    def sweep(self) -> float:
        """Distance of the shape's own surface from the features [m]; 0 for a sharp shape."""

    @property
    @abstractmethod
    def corners(self) -> Vector:
        """Corners of the convex hull of the surface in the body frame [m], shape [n, 3]."""
