"""Sound meshes: formats, volume, centre and inertia in closed form, convexity, cavities."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from bodies import ConvexHull, MeshFile, Triangles
from bodies.meshes.convexity import hull_of
from bodies.meshes.integrals import mass_properties, winding_number
from tests.bodies.meshes import parts


def _box_inertia(x: float, y: float, z: float) -> np.ndarray:
    return x * y * z / 12.0 * np.diag([y**2 + z**2, z**2 + x**2, x**2 + y**2])


@pytest.mark.parametrize("form", ["stl", "stl_ascii", "obj", "ply", "off", "glb"])
def test_formats(form: str, tmp_path: Path) -> None:
    """An L, turned, with volume, centre and inertia as the numbers of the file allow."""
    trimesh = pytest.importorskip("trimesh")
    path = tmp_path / f"part.{form.split('_')[0]}"
    trimesh.Trimesh(*parts.turned(parts.bracket()), process=False).export(str(path), file_type=form)
    mesh, whole = MeshFile(str(path), unit="m").mesh, Triangles(*parts.turned(parts.bracket())).mesh
    assert (len(mesh.vertices), len(mesh.faces)) == (12, 20)
    assert mesh.volume == pytest.approx(4e-4 * 0.015, rel=1e-6)
    np.testing.assert_allclose(mesh.centroid, whole.centroid, atol=1e-8)
    np.testing.assert_allclose(mesh.inertia, whole.inertia, atol=3e-6 * np.max(whole.inertia))
    assert not mesh.is_convex
    assert mesh.volume_ratio == pytest.approx(4e-4 / 5e-4, rel=1e-6)
    assert len(mesh.hull.corners) == 10


@pytest.mark.parametrize("offset", [0.0, 1.0, 1e3])
def test_mass_properties_of_a_box(offset: float) -> None:
    """Exact to the round-off of the coordinates, also far from the origin."""
    shift = offset * np.array([1.0, -2.0, 0.5])
    volume, centre, inertia = mass_properties(*parts.box(0.02, 0.03, 0.05, shift))
    lost = 1e-14 + 1e-15 * offset / 0.02
    assert volume == pytest.approx(3e-5, rel=lost)
    np.testing.assert_allclose(centre, shift, rtol=0, atol=0.02 * lost)
    exact = _box_inertia(0.02, 0.03, 0.05)
    np.testing.assert_allclose(inertia, exact, rtol=0, atol=3.0 * lost * np.max(exact))


def test_mass_properties_of_a_tetrahedron() -> None:
    """Volume 1/6, integral of x^2 1/60, of x y 1/120 from the corner; moved to the centre (1/4, 1/4, 1/4)."""
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    volume, centre, inertia = mass_properties(points, faces)
    assert volume == pytest.approx(1.0 / 6.0, rel=1e-15)
    np.testing.assert_allclose(centre, 0.25, rtol=1e-15)
    square, product = 1.0 / 60.0 - 1.0 / 96.0, 1.0 / 120.0 - 1.0 / 96.0
    np.testing.assert_allclose(inertia, np.full((3, 3), -product) + np.eye(3) * (2.0 * square + product), rtol=1e-13)


def test_against_trimesh() -> None:
    """A torus, turned and shifted."""
    trimesh = pytest.importorskip("trimesh")
    points, faces = parts.turned(parts.torus(), shift=(0.05, 0.02, -0.03))
    other = trimesh.Trimesh(points, faces, process=False)
    volume, centre, inertia = mass_properties(points, faces)
    assert volume == pytest.approx(other.volume, rel=1e-12)
    np.testing.assert_allclose(centre, other.center_mass, atol=1e-14)
    np.testing.assert_allclose(inertia, other.moment_inertia, atol=1e-11 * np.max(inertia))


@pytest.mark.slow
def test_a_refined_sphere_tends_to_a_sphere() -> None:
    """Volume and inertia of an icosphere with the square of the length of its edges: a mesh is a polyhedron."""
    trimesh = pytest.importorskip("trimesh")
    errors = []
    for level in (2, 3, 4):
        ball = trimesh.creation.icosphere(subdivisions=level)
        mesh = Triangles(0.01 * ball.vertices, ball.faces).mesh
        assert mesh.is_convex
        assert mesh.volume_ratio == pytest.approx(1.0, abs=1e-12)
        errors.append(1.0 - mesh.volume / (4.0 / 3.0 * math.pi * 1e-6))
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.02)


def test_winding_number() -> None:
    points, faces = parts.torus()
    for place, times in (((0.02, 0.0, 0.0), 1), ((0.0, 0.0, 0.0), 0), ((0.0, 0.02, 0.004), 1), ((0.05, 0.0, 0.0), 0)):
        assert winding_number(points, faces, np.array(place)) == pytest.approx(times, abs=1e-12)


def test_a_cavity_is_allowed_and_counts() -> None:
    """A box in a box, wound the other way: volumes and inertias subtract."""
    inner = parts.box(0.01, 0.01, 0.02)
    mesh = Triangles(*parts.together(parts.box(), (inner[0], inner[1][:, ::-1]))).mesh
    assert mesh.volume == pytest.approx(3e-5 - 2e-6, rel=1e-12)
    exact = _box_inertia(0.02, 0.03, 0.05) - _box_inertia(0.01, 0.01, 0.02)
    np.testing.assert_allclose(mesh.inertia, exact, atol=1e-12 * np.max(exact))
    assert not mesh.is_convex


def test_a_box_of_many_flat_triangles_has_eight_corners(tmp_path: Path) -> None:
    """In single precision, turned: what lies in faces and on edges is no corner, and it is convex."""
    trimesh = pytest.importorskip("trimesh")
    points, faces = parts.box()
    for _ in range(3):
        points, faces = trimesh.remesh.subdivide(points, faces)
    path = parts.write_stl(tmp_path / "part.stl", parts.turned((points, faces), shift=(0.3, 0.2, -0.1)))
    mesh = MeshFile(str(path), unit="m").mesh
    assert len(mesh.faces) == 12 * 64
    assert mesh.is_convex
    assert len(mesh.hull.corners) == 8
    exact = parts.turned(parts.box(), shift=(0.3, 0.2, -0.1))[0]
    np.testing.assert_allclose(sorted(mesh.hull.corners.tolist()), sorted(exact.tolist()), atol=4e-8)


@pytest.mark.parametrize("name", ["box", "octagon"])
def test_faces_that_single_precision_bends_are_made_flat(name: str) -> None:
    """Corners moved by no more than the precision; a hull with the faces of the body, none of them cut."""
    corners, n_faces = parts.box()[0], 6
    if name == "octagon":
        # a double pyramid cut off below and above, with eight sides: four faces meet in no corner, three in all
        ring = np.array([(math.cos(a), math.sin(a), 0.0) for a in np.linspace(0.0, 2.0 * np.pi, 9)[:-1]])
        up = np.array([0.0, 0.0, 1.0])
        corners, n_faces = 0.01 * np.concatenate([ring + up, 2.0 * ring, ring - up]), 18
    rough = parts.turned((corners, np.zeros(0)), 1.1)[0].astype(np.float32).astype(float)
    hull = hull_of(name, rough)
    assert len(ConvexHull(rough.tolist()).polytope.faces) > n_faces
    flat = ConvexHull(hull.corners.tolist()).polytope
    assert len(flat.faces) == n_faces
    assert len(flat.vertices) == len(corners)
    assert 0.0 < hull.moved < 1e-8


def test_surfaces_are_compared_and_shown_by_what_they_are_made_of(tmp_path: Path) -> None:
    one, other = Triangles(*parts.box()), Triangles(*parts.box())
    assert one == other
    assert one != Triangles(*parts.box(0.021))
    assert one.mesh.digest == other.mesh.digest
    path = str(parts.write_stl(tmp_path / "part.stl", parts.box()))
    assert repr(MeshFile(path, unit="m")) == f"MeshFile(path={path!r}, unit='m', scale=1.0, repair=(), largest=1000000)"
