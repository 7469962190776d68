"""Contacts of a sphere or smooth body with the patches of a surface, of many patches with those near the body."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from nonsmooth.interfaces import CandidateSearch, FeaturePair
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ...meshes.features import Features
from ...meshes.patches import Patches
from ...vectors import vector_at
from ..features.writing import NO_CANDIDATE
from .surface_near import patches_near, seen_from
from .surface_search import FAR
from .surface_tables import N_PATCHES, part_names, surface_numbers

MOST_EACH = 8
"""Largest number of patches of a surface for which each patch is a contact of its own, without a search."""
NEAR = 1.0
"""Kind of a candidate: a patch near the body.

A candidate has three numbers: its kind, the number of the patch, and 0.
"""


def find_near_patches(a: Floats, b: Floats, out: Floats, surface: Floats, extent: float, place: Floats) -> None:
    """Find the patches with a feature near the ball that encloses the second body, about a place in its frame [m]."""
    most, reach = int(surface[N_PATCHES]), extent + out[0]
    out[0] = float(patches_near(surface, seen_from(a, b, vector_at(place, 0)), reach, NEAR, 0.0, out, 0, most))


def patch_contacts(
    evaluator: Callable[..., None],
    own: Features,
    patches: Patches,
    ball: tuple[float, float, float, float],
    values: Mapping[str, Value],
    name: str,
) -> tuple[FeaturePair, ...]:
    """Return one contact for each patch of a surface; if there are many, a search assigns near patches to them.

    There are as many contacts as patches, because all patches can be near.  The number of the patch is the second
    number of the evaluator's argument ``candidate``.

    Parameters
    ----------
    evaluator : callable
        Function that writes the geometry block of the body and a patch.
    own, patches : Features, Patches
        The surface, and how it is divided.
    ball : tuple of float
        Centre, in the second body's frame, and radius of a ball that encloses the second body [m].
    values : mapping
        The parameters of the evaluator, except ``candidate``, ``surface`` and ``size``.
    name : str
        Name of the second body.
    """
    surface = surface_numbers(own, patches, 0.0)
    names = tuple(f"{part} and {name}" for part in part_names(own))
    offered = {**values, "surface": surface, "size": own.size}
    if patches.count <= MOST_EACH:
        given = [(NEAR, float(patch), 0.0, FAR) for patch in range(patches.count)]
        return tuple(FeaturePair(evaluator, {**offered, "candidate": one}, names) for one in given)
    sought: dict[str, Value] = {"surface": surface, "extent": ball[3], "place": ball[:3]}
    search = CandidateSearch(find_near_patches, sought, {NEAR: (patches.count, 1)})
    return (FeaturePair(evaluator, {**offered, "candidate": NO_CANDIDATE}, names, search),) * patches.count
