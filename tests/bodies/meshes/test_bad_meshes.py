"""Every kind of bad mesh: an error or a warning with the figure that shows it and what to do; repairs that say so."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import MeshFile, Triangles
from bodies.meshes.repair import MeshRepaired
from nonsmooth.parameters import UnusualValue
from tests.bodies.meshes import parts

VOLUME = 0.02 * 0.03 * 0.05


def _box_with(**changed: object) -> parts.Mesh:
    points, faces = parts.box()
    for index, value in changed.get("points", ()):  # type: ignore[attr-defined]
        points[index] = value
    return points, np.array(changed.get("faces", faces))


def _t_junction() -> parts.Mesh:
    """Return a box with a vertex amid an edge: between it and one of the faces is a triangle without area."""
    points, faces = parts.box()
    a, b, c = faces[0]
    points = np.concatenate([points, [0.5 * (points[a] + points[b])]])
    new = len(points) - 1
    return points, np.concatenate([faces[1:], [[a, new, c], [new, b, c], [a, b, new]]])


def _nan() -> parts.Mesh:
    return _box_with(points=((3, (np.nan, 0.0, 0.0)), (5, (0.0, np.inf, 0.0))))


def _figure_eight() -> parts.Mesh:
    """Return one closed shell whose tip is pushed through its own far side."""
    points, faces = parts.torus(8, 6)
    points[0] += (-0.06, 0.0, 0.0)
    return points, faces


BOX, FACES = parts.box()
BAD: dict[str, tuple[parts.Mesh, str]] = {
    "open": ((BOX, FACES[:-1]), r": number of open edges must be 0, as of a closed surface, but it is 3\. .*'holes'"),
    "inside out": ((BOX, FACES[:, ::-1]), r"positive volume.*it is -3e-05.*inside out: repair with 'winding'"),
    "one triangle turned": (
        (BOX, np.concatenate([FACES[:-1], FACES[-1:, ::-1]])),
        r"edges whose two triangles are not wound alike must be 0, but it is 3\. .*'winding'",
    ),
    "doubled": (
        parts.together(parts.box(), parts.box()),
        r"edges with more than two triangles must be 0, but it is 18\. .*'duplicates'",
    ),
    "overlapping shells": (
        parts.together(parts.box(), parts.box(at=(0.01, 0.01, 0.01))),
        r"shells with .* must be 1, as of one body, but it is 2\. Volumes \[m\^3\]: 3e-05, 3e-05\. Unite",
    ),
    "two bodies": (
        parts.together(parts.box(), parts.box(at=(1.0, 0.0, 0.0))),
        r"of their own must be 1, as of one body, but it is 2\. ",
    ),
    "through itself": (_figure_eight(), r"that pass through each other must be 0, but it is \d+\. .*unite"),
    "cavity outside": (
        parts.together(parts.box(), (parts.box(at=(0.5, 0.0, 0.0))[0], FACES[:, ::-1])),
        r"enclose a volume|cavities inside",
    ),
    "not a number": (_nan(), r"vertices with nan or infinity must be 0, but it is 2\. They are 2 of 8.*'not_finite'"),
    "zero area": (_t_junction(), r"no triangle of zero area, but it is 1\. Repair with 'zero_area'"),
    "equal corners": ((BOX, np.concatenate([FACES, [[0, 0, 1]]])), r"no triangle of zero area, but it is 1\. "),
    "sheet": ((BOX[:3], np.array([[0, 1, 2], [0, 2, 1]])), r"must enclose a volume"),
    "empty": ((BOX, np.zeros((0, 3))), r"must have triangles|must have the shape"),
    "index out of range": ((BOX, FACES + 1), r"vertices from 0 to 7 only, but it is '\d+ others'"),
}


@pytest.mark.parametrize("name", BAD)
def test_a_bad_mesh_is_refused_with_figure_and_remedy(name: str) -> None:
    (points, faces), told = BAD[name]
    with pytest.raises(ns.InvalidInput, match=told):
        Triangles(points, faces, name)


@pytest.mark.parametrize("name", ["open", "inside out", "not a number", "overlapping shells"])
def test_a_bad_file_is_refused_by_its_name(name: str, tmp_path: Path) -> None:
    path = parts.write_stl(tmp_path / "part.stl", BAD[name][0])
    with pytest.raises(ns.InvalidInput, match=r"^mesh part\.stl"):
        MeshFile(str(path), unit="m")


@pytest.mark.parametrize(("unit", "extent"), [("m", "50 m"), ("um", "5e-05 m")])
def test_a_wrong_unit_is_told_with_the_size(unit: str, extent: str, tmp_path: Path) -> None:
    """A part of 50 mm, written in millimetres."""
    points, faces = parts.box(20.0, 30.0, 50.0)
    path = parts.write_stl(tmp_path / "part.stl", (points, faces))
    with pytest.warns(UnusualValue, match=rf"part\.stl: the largest extent is {extent}.*read as '{unit}'.*'mm'"):
        MeshFile(str(path), unit=unit)
    assert MeshFile(str(path), unit="mm").mesh.extent == pytest.approx(0.05)
    assert MeshFile(str(path), unit="mm", scale=0.5).mesh.extent == pytest.approx(0.025)


def test_there_is_no_default_unit(tmp_path: Path) -> None:
    path = parts.write_stl(tmp_path / "part.stl", parts.box())
    with pytest.raises(TypeError, match="unit"):
        MeshFile(str(path))  # type: ignore[call-arg]
    with pytest.raises(ns.UnknownName, match=r"part\.stl: unknown unit.*Known: cm, .*mm, um"):
        MeshFile(str(path), unit="metre")


HEADS = {
    "stl": lambda n: b"\0" * 80 + np.uint32(n).tobytes(),
    "ply": lambda n: b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nelement face %d\nend_header\n" % n,
    "off": lambda n: b"OFF\n3 %d 0\n" % n,
}


@pytest.mark.parametrize("form", HEADS)
def test_ten_million_triangles_are_refused_by_the_header_alone(form: str, tmp_path: Path) -> None:
    """A file whose head says so, the rest zeros without a block on disk, is not read."""
    path = tmp_path / f"huge.{form}"
    with path.open("wb") as file:
        file.write(HEADS[form](10_000_000))
        file.truncate(84 + 50 * 10_000_000)
    began = time.perf_counter()
    with pytest.raises(ns.InvalidInput, match=r"huge.* at most 1000000 triangles, but it is 10000000\. Simplify"):
        MeshFile(str(path), unit="mm")
    assert time.perf_counter() - began < 0.5


@pytest.mark.parametrize("form", ["stl", "obj", "ply", "off", "glb", "stl_ascii"])
def test_the_number_of_triangles_is_told_from_the_file(form: str, tmp_path: Path) -> None:
    """Before it is loaded; a bound below it refuses the file."""
    trimesh = pytest.importorskip("trimesh")
    path = tmp_path / f"part.{form.split('_')[0]}"
    trimesh.Trimesh(*parts.torus(), process=False).export(str(path), file_type=form)
    with pytest.raises(ns.InvalidInput, match=r"at most 500 triangles, but it is 576\. "):
        MeshFile(str(path), unit="m", largest=500)
    assert len(MeshFile(str(path), unit="m").mesh.faces) == 576


def test_many_triangles_are_warned_of(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    from bodies.meshes import counting

    monkeypatch.setattr(counting, "MANY", 500)
    path = parts.write_stl(tmp_path / "part.stl", parts.torus())
    with pytest.warns(UnusualValue, match=r"part\.stl has 576 triangles: .* Simplify"):
        MeshFile(str(path), unit="m")


@pytest.mark.slow
def test_a_fine_surface_that_passes_through_itself_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of 204 800 triangles, a tip pushed through the far side; where there are too many near pairs, it is said."""
    from bodies.meshes import checks

    points, faces = parts.torus(320, 320)
    tip = np.linalg.norm(points - points[0], axis=1) < 0.004
    points[tip] += (-0.1, 0.0, 0.0)
    assert len(faces) > 200_000
    with pytest.raises(ns.InvalidInput, match=r"that pass through each other must be 0, but it is \d+\. .*unite"):
        Triangles(points, faces)
    monkeypatch.setattr(checks, "MOST_PAIRS", 1000)
    with pytest.warns(UnusualValue, match=r"was not looked at for passing through itself: of 576 .* Simplify"):
        Triangles(*parts.torus())


def test_broken_files(tmp_path: Path) -> None:
    """No file, an unknown ending, rubbish, a cloud of points."""
    for name, content, told in (
        ("none.stl", None, r"must be a file"),
        ("part.xxx", b"abc", r"part\.xxx must be a mesh that trimesh can read.*Formats: .*stl"),
        ("part.glb", b"abc", r"part\.glb must be a mesh that trimesh can read"),
        ("part.stl", b"\x00" * 80 + b"\x09\x00\x00\x00" + b"\x81" * 30, r"must (be a mesh|have triangles).*file whole"),
        ("points.xyz", b"0 0 0\n1 0 0\n0 1 0\n", r"points\.xyz must (be a mesh|have triangles)"),
    ):
        path = tmp_path / name
        if content is not None:
            path.write_bytes(content)
        with pytest.raises(ns.InvalidInput, match=told):
            MeshFile(str(path), unit="mm")


def test_a_reader_that_misses_a_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The readers of broken text and of rare formats ask for some: that is not told as the fault."""
    trimesh = pytest.importorskip("trimesh")

    def fails(*_: Any, **__: Any) -> Any:
        raise ModuleNotFoundError("No module named 'cascadio'", name="cascadio")

    monkeypatch.setattr(trimesh, "load_mesh", fails)
    (tmp_path / "part.step").write_bytes(b"abc")
    told = r"it is \"broken, or of a format that needs the package 'cascadio'\"\. Is the file whole.*STL, OBJ"
    with pytest.raises(ns.InvalidInput, match=told):
        _ = MeshFile(str(tmp_path / "part.step"), unit="mm").mesh


REPAIRS = {
    "open": ("holes", r"1 holes closed by 1 triangles of 0\.0003 m\^2, 4\.84% of the surface"),
    "inside out": ("winding", r"12 triangles turned round; volume -3e-05 -> 3e-05"),
    "one triangle turned": ("winding", r"1 triangles turned round"),
    "doubled": ("duplicates", r"12 triangles that came twice left out; volume 6e-05 -> 3e-05"),
    "zero area": ("zero_area", r"1 triangles of zero area left out, 1 neighbours cut in two; volume 3e-05 -> 3e-05"),
    "equal corners": ("zero_area", r"1 triangles of zero area left out, 0 neighbours"),
}


@pytest.mark.parametrize("name", REPAIRS)
def test_a_repair_gives_the_body_back_and_says_what_it_changed(name: str) -> None:
    word, told = REPAIRS[name]
    (points, faces), _ = BAD[name]
    with pytest.warns(MeshRepaired, match=f"mesh {name} was repaired: {word}: {told}"):
        mesh = Triangles(points, faces, name, repair=(word,)).mesh
    assert mesh.volume == pytest.approx(VOLUME, rel=1e-12)
    assert len(mesh.repairs) == 1
    assert mesh.repairs[0] in mesh.report()


def test_a_box_without_a_lid_is_closed() -> None:
    """A fan about the middle of the hole; volume and inertia are those of the box."""
    points, faces = parts.box()
    with pytest.warns(MeshRepaired, match="1 holes closed by 4 triangles"):
        closed = Triangles(points, faces[:-2], repair=("holes",)).mesh
    whole = Triangles(points, faces).mesh
    assert closed.volume == pytest.approx(whole.volume, rel=1e-12)
    np.testing.assert_allclose(closed.inertia, whole.inertia, atol=1e-12 * np.max(whole.inertia))


def test_vertices_that_nearly_meet_are_merged() -> None:
    """Corners of each triangle moved by up to 1e-8 m."""
    points, faces = parts.box()
    soup = points[faces].reshape(-1, 3) + np.random.default_rng(1).uniform(-1e-8, 1e-8, (36, 3))
    numbers = np.arange(36).reshape(-1, 3)
    with pytest.raises(ns.InvalidInput, match=r"open edges must be 0.*, but it is 36\. .*'merge'"):
        Triangles(soup, numbers)
    with pytest.warns(MeshRepaired, match=r"28 vertices merged, moved by up to \S*e-0[89] m"):
        assert Triangles(soup, numbers, repair=("merge",)).mesh.volume == pytest.approx(VOLUME, rel=1e-5)


def test_vertices_that_are_not_finite_are_cut_out() -> None:
    points, faces = parts.torus()
    points[17] = np.nan
    with pytest.warns(MeshRepaired) as told:
        mesh = Triangles(points, faces, repair=("holes", "not_finite")).mesh
    assert [str(one.message).split(": ")[1] for one in told] == ["not_finite", "holes"]
    whole = Triangles(*parts.torus()).mesh
    assert mesh.volume == pytest.approx(whole.volume, rel=0.02)
    assert mesh.volume != whole.volume


def test_nothing_is_repaired_that_was_not_asked_for() -> None:
    """A word that is not known, a word in place of a tuple, and the wrong repair, which leaves the error."""
    points, faces = BAD["open"][0]
    with pytest.raises(ns.UnknownName, match=r"repair.*Did you mean 'holes'"):
        Triangles(points, faces, repair=("hole",))
    with pytest.raises(ns.InvalidInput, match=r"must be a tuple of words.*\('holes',\)"):
        Triangles(points, faces, repair="holes")  # type: ignore[arg-type]
    with pytest.raises(ns.InvalidInput, match="open edges"):
        Triangles(points, faces, repair=("merge", "zero_area"))
    assert Triangles(*parts.box(), repair=("holes", "winding", "merge")).mesh.repairs == ()


@pytest.mark.parametrize(("thickness", "is_told"), [(1e-9, True), (1e-6, False)])
def test_a_sliver_whose_faces_count_as_one_is_refused(thickness: float, is_told: bool) -> None:
    """Below 2e-7 of the size single precision does not tell its faces apart: no hull is made of it."""
    points, faces = parts.box(0.1, 0.1, thickness)
    mesh = Triangles(points.tolist(), faces.tolist(), "sliver").mesh
    if is_told:
        with pytest.raises(ns.InvalidInput, match=r"mesh sliver must be thicker than 2e-08 m.* but it is 1"):
            mesh.report()
    else:
        assert "8 corners of the hull" in mesh.report()


def test_a_format_of_another_package_names_it(tmp_path: Path) -> None:
    (tmp_path / "part.step").write_text("ISO-10303-21;")
    with pytest.raises(ns.InvalidInput, match=r"part\.step must be a mesh that trimesh can read.*cascadio"):
        MeshFile(str(tmp_path / "part.step"), unit="m")
