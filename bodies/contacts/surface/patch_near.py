"""Base class for contacts of a sphere or smooth body with a surface of many patches.

A search finds the patches near the body; only these patches are evaluated as contacts.
"""

from __future__ import annotations

from abc import ABC
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Self

from nonsmooth.interfaces import CandidateSearch, ContactKinematics
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...meshes.patches import Patches
from ..features.frames import point_in_body, point_in_world
from ..features.writing import NO_CANDIDATE
from .surface_near import patches_near
from .surface_tables import N_PATCHES, surface_numbers

MOST_EACH = 8
"""Largest number of patches of a surface for which each patch is a contact of its own, without a search."""
NEAR = 1.0
"""Kind of a candidate: a patch near the body.

A candidate has three numbers: its kind, the number of the patch, and 0.
"""


def _find(
    a: Floats, b: Floats, out: Floats, surface: Floats, extent: float, x_b: float, y_b: float, z_b: float
) -> None:
    """Find the patches with a feature near the ball that encloses the second body."""
    x, y, z = point_in_world(b, (x_b, y_b, z_b))
    x, y, z = point_in_body(a, (x, y, z))
    most = int(surface[N_PATCHES])
    out[0] = float(patches_near(surface, x, y, z, extent + out[0], NEAR, 0.0, out, 0, most))


def are_many(patches: Patches) -> bool:
    """Return whether there are too many patches for a contact each, so that near patches are searched for."""
    return patches.count > MOST_EACH


@dataclass(frozen=True)
class PatchNear(ContactKinematics, ABC):
    """Contact of a sphere or smooth body with one patch of a surface, which changes as the bodies move.

    A search assigns a patch near the body to the contact.  The number of this patch is the second number of the
    evaluator's argument ``candidate``.

    Attributes
    ----------
    search : CandidateSearch
        Search for patches near the body.
    values : mapping
        The parameters of the evaluator, except ``candidate``.
    n_features : int
        Number of features of the surface.
    number : int
        Number of this contact among the contacts of both bodies.
    """

    search: CandidateSearch
    values: Mapping[str, Value]
    n_features: int
    number: int

    @classmethod
    def _of_patches(
        cls,
        own: Features,
        patches: Patches,
        ball: tuple[float, float, float, float],
        values: Mapping[str, Value],
    ) -> tuple[Self, ...]:
        """Return contacts with near patches, one for each patch of the surface, because all patches can be near.

        Parameters
        ----------
        own, patches : Features, Patches
            The surface, and how it is divided.
        ball : tuple of float
            Centre, in the second body's frame, and radius of a ball that encloses the second body [m].
        values : mapping
            The parameters of the evaluator, except ``candidate``, ``surface`` and ``size``.
        """
        surface = surface_numbers(own, patches)
        x, y, z, extent = ball
        search = CandidateSearch(
            _find,
            {"surface": surface, "extent": extent, "x_b": x, "y_b": y, "z_b": z},
            {NEAR: (patches.count, 1)},
        )
        offered = {**values, "surface": surface, "size": own.size}
        n = len(own.planes) + len(own.edges) + len(own.corners)
        return tuple(cls(search, offered, n, number) for number in range(patches.count))

    @property
    def candidates(self) -> CandidateSearch:
        """Search for patches near the body."""
        return self.search

    def parameters(self) -> dict[str, Value]:
        """Return the parameters of the evaluator.

        The parameter ``candidate`` is a placeholder without a patch; the search assigns the patch during the run.
        """
        return {**self.values, "candidate": NO_CANDIDATE}

    @property
    def features(self) -> tuple[str, ...]:
        """The features of the surface, by number."""
        return tuple(f"feature {i}" for i in range(self.n_features))
