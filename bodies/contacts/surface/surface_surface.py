"""Contacts of two boxes, hulls, capsules or meshes, and of these with points and spheres."""

from __future__ import annotations

from typing import final

import numpy as np

from nonsmooth.interfaces import ContactKinematics, FeaturePair, Shape

from ...meshes.features import Features
from ...shapes.point import Point
from ...shapes.sphere import Sphere
from ...shapes.surface_shape import SurfaceShape
from .surface_pairs import Swept, contacts_of


def _swept(shape: Shape) -> Swept:
    """Return a surface, with the radius about it, as one side of a contact."""
    assert isinstance(shape, SurfaceShape)
    return Swept(shape.features, shape.sweep, shape.extent)


def _ball(shape: Point | Sphere, radius: float, name: str) -> Swept:
    """Return a ball as a surface: a single corner, without edges, and a radius about it [m]."""
    nothing, place = np.zeros((0, 3)), np.array([[shape.x, shape.y, shape.z]])
    whole = nothing.astype(np.int64)
    features = Features(place, whole, whole[:, 0], np.zeros((0, 4)), nothing > 0.0, (), (0,), ((),))
    return Swept(features, radius, shape.extent, name)


@final
class SurfaceSurface(ContactKinematics):
    """Contacts of two surfaces: edges that cross, and corners of either body over patches of the other.

    A surface is a box, a hull, a capsule or a mesh, convex or not.  A face on a face is several such contacts at once.
    Which contacts can close depends only on the surfaces next to the contact points, so that the bodies need not be
    convex.

    A corner touches a patch, faces of which it touches only one at a time (:mod:`bodies.meshes.patches`).  A convex
    surface is one patch.  If one of the bodies is rounded, a corner is a ball or a point, and touches the nearest face,
    edge or corner.  If there are more than a few pairs of features, a search assigns near pairs to the contacts.
    """

    pair = SurfaceShape, SurfaceShape

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return the contacts of pairs of edges, then of the second body's corners, then of the first's corners."""
        return contacts_of(_swept(first), _swept(second))


@final
class SurfacePoint(ContactKinematics):
    """Contacts of a point with the patches of a surface; in an inner corner, a point touches two faces at once."""

    pair = SurfaceShape, Point

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return a contact for each patch, or for near ones if there are many."""
        assert isinstance(second, Point)
        return contacts_of(_swept(first), _ball(second, 0.0, "point"))


@final
class SurfaceSphere(ContactKinematics):
    """The contact of a sphere with the nearest face, convex edge or corner of each patch of a surface.

    The surface is divided into patches, so that a sphere of this size touches one feature of a patch at a time
    (:mod:`bodies.meshes.patches`).  A convex surface is one patch; a mesh with inner corners has two or more.
    """

    pair = SurfaceShape, Sphere

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[FeaturePair, ...]:
        """Return a contact for each patch, or for near ones if there are many."""
        assert isinstance(second, Sphere)
        return contacts_of(_swept(first), _ball(second, second.radius, "sphere"))
