"""Flat faces, convex edges, corners and patches of surfaces."""

from __future__ import annotations

import itertools
import re
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from bodies.meshes import patches as patches_module
from bodies.meshes.features import Features, features_of
from bodies.meshes.patches import patches_for_ball, patches_for_body
from nonsmooth import InvalidInput
from tests.bodies.meshes.parts import box, bracket, hills, together, torus, turned

Array = NDArray[Any]


def finer(points: Array, triangles: Array) -> tuple[Array, Array]:
    """Return the mesh with every triangle cut into four."""
    halves: dict[tuple[int, int], int] = {}
    more, cut = points.tolist(), []
    for triangle in triangles.tolist():
        middle = []
        for one, two in zip(triangle, [*triangle[1:], triangle[0]], strict=True):
            key = min(one, two), max(one, two)
            if key not in halves:
                halves[key] = len(more)
                more.append((0.5 * (points[one] + points[two])).tolist())
            middle.append(halves[key])
        (a, b, c), (d, e, f) = triangle, middle
        cut += [(a, d, f), (d, b, e), (f, e, c), (d, e, f)]
    return np.array(more), np.array(cut)


def counts(features: Features) -> tuple[int, int, int]:
    return len(features.planes), len(features.edges), len(features.corners)


def test_triangles_in_a_plane_are_one_face_and_edges_in_line_one_edge() -> None:
    """However finely a box is cut."""
    plain, cut = features_of(*box()), features_of(*finer(*finer(*box())))
    assert counts(plain) == counts(cut) == (6, 12, 8)
    assert len(cut.triangles) == 192
    lengths = [np.linalg.norm(np.subtract(*cut.vertices[list(edge[:2])])) for edge in cut.edges]
    np.testing.assert_allclose(np.sort(lengths), np.repeat([0.02, 0.03, 0.05], 4), rtol=1e-14)


def test_faces_that_single_precision_bent_are_flat_again() -> None:
    points, triangles = finer(*finer(*box()))
    turned = Rotation.from_euler("xyz", (0.3, 0.8, -1.1)).apply(points) + np.array([0.01, 0.02, 0.05])
    rounded = turned.astype(np.float32).astype(float)
    features = features_of(rounded, triangles)
    assert counts(features) == (6, 12, 8)
    assert np.max(np.abs(features.vertices - rounded)) < 1e-8
    planes = features.planes[features.face_of]
    heights = np.einsum("nij,nj->ni", features.vertices[features.triangles], planes[:, :3]) - planes[:, 3:]
    assert np.max(np.abs(heights)) < 1e-16


def test_what_can_touch_of_a_bracket() -> None:
    """The edge in the inner corner cannot, and its ends are tips of no plane."""
    features = features_of(*bracket())
    assert counts(features) == (8, 17, 10)
    assert {3, 9}.isdisjoint(features.corners)
    assert all({one, two} != {3, 9} for one, two, _, _ in features.edges)


@pytest.mark.parametrize("radius", [0.0, 1e-3, 1.0, np.inf])
def test_a_convex_surface_is_one_patch(radius: float) -> None:
    assert patches_for_body(features_of(*finer(*box())), radius).count == 1


def test_the_walls_of_an_inner_corner_are_two_patches() -> None:
    features = features_of(*bracket())
    patches = patches_for_ball(features, 2e-3)
    assert patches.count == 2
    inner = [i for i, plane in enumerate(features.planes.tolist()) if np.isclose(plane[3], 0.01)]
    assert len({patches.of_faces[i] for i in inner}) == 2


def test_larger_balls_touch_more_at_once() -> None:
    """In the hole of a torus one that fits has neighbours to fear only, one that does not all that is opposite."""
    features = features_of(*torus())
    few, more = (patches_for_ball(features, radius).count for radius in (1e-3, 1e-2))
    assert 2 <= few < more


@pytest.mark.fast_cases(6)
@pytest.mark.parametrize("mesh", [torus(12, 6), bracket(), hills(7)], ids=["torus", "bracket", "hills"])
@pytest.mark.parametrize("radius", [1e-3, 1e-2, 0.3])
def test_a_patch_has_no_two_faces_that_a_ball_touches_at_once(mesh: Any, radius: float) -> None:
    """Each face held against each, as the search for near ones must not leave out any."""
    features = features_of(*mesh)
    patches, planes = patches_for_ball(features, radius), features.planes
    corners = [features.vertices[features.triangles[features.face_of == f]].reshape(-1, 3) for f in range(len(planes))]
    least, together = 1e-9 * features.size, 0
    for one, two in itertools.combinations(range(len(planes)), 2):
        if patches.of_faces[one] == patches.of_faces[two]:
            a, b = corners[one], corners[two]
            over = min(np.max(a @ planes[two, :3] - planes[two, 3]), np.max(b @ planes[one, :3] - planes[one, 3]))
            apart = np.linalg.norm(np.maximum(np.maximum(a.min(0) - b.max(0), b.min(0) - a.max(0)), 0.0))
            reach = radius * float(np.linalg.norm(planes[one, :3] - planes[two, :3]))
            assert over <= least or apart > reach
            together += 1
    assert together > 0


def test_surfaces_too_fine_for_a_body_are_refused_with_their_number(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where too many faces may be touched at once; a convex surface has none, however fine."""
    monkeypatch.setattr(patches_module, "MOST_PAIRS", 20)
    with pytest.raises(InvalidInput, match=r"at most 20 pairs of faces.*decomposition"):
        patches_for_ball(features_of(*torus()), 0.5)
    assert patches_for_ball(features_of(*box()), 0.5).count == 1


@pytest.mark.slow
def test_much_memory_and_time_are_told_beforehand(capfd: pytest.CaptureFixture[str]) -> None:
    """From some 20 000 triangles on for a small ball, from fewer for a body that touches more at once."""
    fewer, more = (features_of(*hills(n)) for n in (55, 75))
    patches_for_ball(fewer, 0.02)
    assert capfd.readouterr().err == ""
    patches_for_body(fewer, 0.12)
    assert re.fullmatch(
        r"making contacts of bodies of 0.12 m with a mesh of 12540 triangles .*\n", capfd.readouterr().err
    )
    for _ in range(2):
        patches_for_ball(more, 0.02)
    told = re.fullmatch(
        r"making contacts of bodies of 0.04 m with a mesh of 23100 triangles \(some (\d+) MB .*, and (\d) s, .*\n",
        capfd.readouterr().err,
    )
    assert told is not None
    # the benchmark measures 170 MB, and 2 s where nothing else runs
    assert 85 <= int(told[1]) <= 340
    assert told[2] in "1234"


@pytest.mark.slow
@pytest.mark.parametrize("diameter", [0.05, 0.3])
def test_pairs_are_told_by_a_part_of_the_faces(monkeypatch: pytest.MonkeyPatch, diameter: float) -> None:
    """Of surfaces whose parts differ in size."""
    surface = features_of(*together(hills(25), turned(torus(40, 20), shift=(0.0, 0.0, 1.0))))
    monkeypatch.setattr(patches_module, "_COSTS", np.eye(4)[:, [1, 3]])
    search, told = patches_module._search(surface, diameter, lambda i, _: np.full(len(i), diameter)), []
    for sample in (len(surface.planes), len(surface.planes) // 8):
        monkeypatch.setattr(patches_module, "_SAMPLE", sample)
        told.append(patches_module._cost(surface, search))
    np.testing.assert_allclose(told[1], told[0], rtol=0.15)
