"""Repairs of a mesh: only repairs that the user names are made, in a fixed order; each warns of its change."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import numpy as np

from nonsmooth.errors import InvalidInput, NonsmoothWarning, UnknownName
from nonsmooth.interfaces.body import Vector
from nonsmooth.notices import warn

from .checks import flat_triangles
from .integrals import areas_of, volume_of
from .topology import Integers, edge_counts, half_edges, merge_equal, neighbours, shells

Repaired = tuple[Vector, Integers, str]

NEAR = 1e-6
"""Distance below which 'merge' makes vertices one, relative to the largest extent."""


class MeshRepaired(NonsmoothWarning):
    """A repair that the user named has changed the mesh."""


def repaired(thing: str, vertices: Vector, faces: Integers, words: Iterable[str]) -> tuple[Vector, Integers, list[str]]:
    """Return the mesh after the repairs named, and a line for each that changed something; all are warnings as well.

    Raises
    ------
    UnknownName
        If there is no repair of that name.
    """
    words = tuple(words)
    for word in words:
        if word not in REPAIRS:
            raise UnknownName(f"{thing}: repair", str(word), REPAIRS)
    lines = []
    for word, repair in REPAIRS.items():
        if word not in words:
            continue
        before = _volume(vertices, faces)
        vertices, faces, told = repair(vertices, faces)
        if len(faces) == 0:
            raise InvalidInput(thing, f"must have triangles left after the repair {word!r}", 0, "Export it anew.")
        if told:
            after = _volume(vertices, faces)
            lines.append(f"{word}: {told}; volume {before:.6g} -> {after:.6g} m^3")
            warn(f"{thing} was repaired: {lines[-1]}", MeshRepaired)
    return vertices, faces, lines


def _volume(vertices: Vector, faces: Integers) -> float:
    with np.errstate(all="ignore"):
        return volume_of(vertices, faces)


def _not_finite(vertices: Vector, faces: Integers) -> Repaired:
    bad = ~np.all(np.isfinite(vertices), axis=1)
    dropped = np.any(bad[faces], axis=1)
    if not np.any(dropped):
        return vertices, faces, ""
    left = faces[~dropped]
    kept = merge_equal(vertices, left) if len(left) else (vertices, left)
    return *kept, f"{np.sum(bad)} vertices that are not finite left out, with {np.sum(dropped)} triangles"


def _merge(vertices: Vector, faces: Integers) -> Repaired:
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    pairs = cKDTree(vertices).query_pairs(NEAR * float(np.max(np.ptp(vertices, axis=0))), output_type="ndarray")
    if len(pairs) == 0:
        return vertices, faces, ""
    n = len(vertices)
    links = coo_matrix((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(n, n))
    count, group = connected_components(links, directed=False)
    sums = np.stack([np.bincount(group, weights=vertices[:, i]) for i in range(3)], axis=1)
    places: Vector = np.asarray(sums / np.bincount(group)[:, None], dtype=float)
    shift = float(np.max(np.linalg.norm(places[group] - vertices, axis=1)))
    return *merge_equal(
        places, group[faces].astype(np.int64)
    ), f"{n - count} vertices merged, moved by up to {shift:.3g} m"


def _duplicates(vertices: Vector, faces: Integers) -> Repaired:
    """Of triangles with the same corners one is left; two that face each other are a wall without thickness and go."""
    _, which, counts = np.unique(np.sort(faces, axis=1), axis=0, return_inverse=True, return_counts=True)
    which = which.reshape(-1)
    lowest = np.argmin(faces, axis=1)
    turned = np.take_along_axis(faces, (lowest[:, None] + np.arange(3)) % 3, axis=1)
    sense = np.where(turned[:, 1] < turned[:, 2], 1, -1)
    total = np.bincount(which, weights=sense, minlength=len(counts))
    first = np.full(len(counts), -1)
    for i in np.flatnonzero(sense * total[which] > 0)[::-1]:
        first[which[i]] = i
    kept = np.sort(first[first >= 0])
    if len(kept) == len(faces):
        return vertices, faces, ""
    return *merge_equal(vertices, faces[kept]), f"{len(faces) - len(kept)} triangles that came twice left out"


def _zero_area(vertices: Vector, faces: Integers) -> Repaired:
    """Triangles with two equal corners go; of one with its corners in a line, the neighbour at the long edge is cut."""
    n_before, dropped, cut = len(faces), 0, 0
    for _ in range(n_before):
        twice = np.any(faces == np.roll(faces, 1, axis=1), axis=1)
        dropped += int(np.sum(twice))
        faces = faces[~twice]
        flat = np.flatnonzero(flat_triangles(vertices, faces))
        if len(flat) == 0:
            break
        faces = _cut_neighbour(vertices, faces, int(flat[0]))
        cut += 1
    if dropped + cut == 0:
        return vertices, faces, ""
    return *merge_equal(
        vertices, faces
    ), f"{dropped + cut} triangles of zero area left out, {cut} neighbours cut in two"


def _cut_neighbour(vertices: Vector, faces: Integers, flat: int) -> Integers:
    corners = vertices[faces[flat]]
    lengths = [float(np.linalg.norm(corners[(i + 1) % 3] - corners[i])) for i in range(3)]
    i = int(np.argmax(lengths))
    start, end, between = (int(faces[flat, (i + k) % 3]) for k in range(3))
    others = [t for t in np.flatnonzero(np.sum((faces == start) | (faces == end), axis=1) == 2) if t != flat]
    new = []
    for t in others:
        k = next(k for k in range(3) if faces[t, k] not in (start, end))
        tip, one, two = (int(faces[t, (k + j) % 3]) for j in range(3))
        new += [(tip, one, between), (tip, between, two)]
    left = np.delete(faces, np.array([flat, *others], dtype=np.int64), axis=0)
    return np.concatenate([left, np.array(new, dtype=np.int64).reshape(-1, 3)])


def _winding(vertices: Vector, faces: Integers) -> Repaired:
    faces, turned = orient(vertices, faces)
    return vertices, faces, f"{turned} triangles turned round" if turned else ""


def _holes(vertices: Vector, faces: Integers) -> Repaired:
    return close_holes(vertices, faces)


REPAIRS: dict[str, Callable[[Vector, Integers], Repaired]] = {
    "not_finite": _not_finite,
    "merge": _merge,
    "duplicates": _duplicates,
    "zero_area": _zero_area,
    "winding": _winding,
    "holes": _holes,
}
"""Repairs by name, in the order in which they are made."""


def close_holes(vertices: Vector, faces: Integers) -> tuple[Vector, Integers, str]:
    """Return vertices [m] and triangles with all holes closed, and a note of the triangles added.

    A hole is a ring of open edges.  A ring of three edges gets one triangle, a longer one a fan of triangles round a
    vertex in its middle: exact if the hole is flat and star-shaped.
    """
    rings = _rings(faces)
    if not rings:
        return vertices, faces, ""
    points, new = [vertices], []
    n = len(vertices)
    for ring in rings:
        if len(ring) == 3:
            new.append(tuple(ring))
            continue
        points.append(np.mean(vertices[ring], axis=0)[None])
        new += [(ring[i], ring[(i + 1) % len(ring)], n) for i in range(len(ring))]
        n += 1
    whole, added = np.concatenate(points), np.array(new, dtype=np.int64)
    area = float(np.sum(areas_of(whole, added)))
    share = area / (area + float(np.sum(areas_of(vertices, faces))))
    told = f"{len(rings)} holes closed by {len(added)} triangles of {area:.3g} m^2, {share:.2%} of the surface"
    return whole, np.concatenate([faces, added]), told


def _rings(faces: Integers) -> list[list[int]]:
    """Return the vertices of every ring of open edges, in the sense opposite to the triangles at the edges."""
    _, counts, which = edge_counts(faces)
    edges = half_edges(faces)[counts[which] == 1]
    following: dict[int, list[int]] = {}
    for start, end in edges.tolist():
        following.setdefault(end, []).append(start)
    rings = []
    while following:
        ring = [next(iter(following))]
        while following.get(ring[-1]):
            after = following[ring[-1]].pop()
            if not following[ring[-1]]:
                del following[ring[-1]]
            if after == ring[0]:
                rings.append(ring)
                break
            ring.append(after)
        else:
            # skip this ring: it does not close, because neighbouring triangles have opposite orientations, which the
            # check of edges reports
            following.pop(ring[-1], None)
    return rings


def orient(vertices: Vector, faces: Integers) -> tuple[Integers, int]:
    """Return the triangles, each wound like its neighbours, and how many were turned.

    A single shell gets a positive volume.  In a mesh of several shells only the winding distinguishes a cavity from a
    body; there each shell gets the sense in which most of its triangles are wound.
    """
    flipped = _flips(faces)
    number = shells(faces)
    several = int(np.max(number)) > 0
    for i in range(int(np.max(number)) + 1):
        own = number == i
        if several:
            inverted = 2 * np.sum(flipped[own]) > np.sum(own)
        else:
            inverted = volume_of(vertices, _turned(faces[own], flipped[own])) < 0.0
        if inverted:
            flipped[own] = ~flipped[own]
    return _turned(faces, flipped), int(np.sum(flipped))


def _turned(faces: Integers, flipped: np.ndarray) -> Integers:
    return np.where(flipped[:, None], faces[:, ::-1], faces)


def _flips(faces: Integers) -> np.ndarray:
    """Return True for each triangle whose vertex order must be reversed, shape [m].

    After that, all triangles of a shell are oriented like the first triangle of the shell.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import breadth_first_order

    pairs, edges, m = neighbours(faces), half_edges(faces), len(faces)
    one, two = pairs[:, 0] // 3, pairs[:, 1] // 3
    # two half edges that run the same way belong to triangles wound against each other
    against = edges[pairs[:, 0], 0] == edges[pairs[:, 1], 0]
    relation = {}
    for i, j, differ in zip(one.tolist(), two.tolist(), against.tolist(), strict=True):
        relation[i, j] = relation[j, i] = differ
    links = coo_matrix((np.ones(2 * len(one)), (np.append(one, two), np.append(two, one))), shape=(m, m)).tocsr()
    flipped, seen = np.zeros(m, dtype=bool), np.zeros(m, dtype=bool)
    for root in range(m):
        if seen[root]:
            continue
        order, before = breadth_first_order(links, root, directed=False)
        seen[order] = True
        for i in order[1:].tolist():
            flipped[i] = flipped[before[i]] ^ relation[int(before[i]), i]
    return flipped
