"""A VTK series has the surfaces where the bodies were."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ElementTree
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import nonsmooth as ns
from nonsmooth.scene.scene import Scene

_TYPES = {"Float32": "<f4", "Int32": "<i4"}


def _series(path: Path) -> list[tuple[float, Path]]:
    root = ElementTree.fromstring(path.read_text(encoding="utf-8"))
    return [(float(one.attrib["timestep"]), path.parent / one.attrib["file"]) for one in root.iter("DataSet")]


def _arrays(path: Path) -> dict[str, NDArray[Any]]:
    head, blob = path.read_bytes().split(b'<AppendedData encoding="raw">_', 1)
    found = {}
    for words in re.findall(r"<DataArray ([^>]*)/>", head.decode("ascii")):
        told = dict(re.findall(r'(\w+)="([^"]*)"', words))
        at = int(told["offset"])
        size = int(np.frombuffer(blob, "<u8", 1, at)[0])
        rows = np.frombuffer(blob[at + 8 : at + 8 + size], _TYPES[told["type"]])
        found[told["Name"]] = rows.reshape(-1, int(told["NumberOfComponents"]))
    return found


def test_points_are_where_the_scene_puts_them(drift: ns.Solution, tmp_path: Path) -> None:
    series = _series(drift.export(tmp_path / "run.pvd", count=7))
    times = np.array([time for time, _ in series])
    np.testing.assert_allclose(times, np.linspace(0.0, drift.t_end, 7), rtol=1e-15)
    scene, states = Scene.of(drift.system), drift.at(times)
    origin, axes = scene.places(times, states["q"], states["u"])
    solid = next(part for part in scene.parts if len(part.look.triangles))
    body = drift.system.names.bodies.index("dumbbell")
    for i, (_, file) in enumerate(series):
        found = _arrays(file)
        points, corners = found["Points"], found["connectivity"].reshape(-1, 3)
        places = origin[i, solid.frame] + solid.look.vertices @ axes[i, solid.frame].T
        shown = points[corners[found["body"][:, 0] == body][: len(solid.look.triangles)]]
        np.testing.assert_allclose(shown, places[solid.look.triangles], atol=1e-7)
        np.testing.assert_array_equal(found["offsets"][:, 0], 3 * np.arange(1, len(corners) + 1))
        assert np.max(corners) < len(points)


def test_strokes_have_no_body(arm: ns.Solution, tmp_path: Path) -> None:
    (_, file), *_ = _series(arm.export(tmp_path / "run.pvd", count=2))
    assert -1 in _arrays(file)["body"]


def test_pyvista_opens_it(drift: ns.Solution, tmp_path: Path) -> None:
    pyvista = pytest.importorskip("pyvista")
    reader = pyvista.get_reader(str(drift.export(tmp_path / "run.pvd", count=5)))
    assert len(reader.time_values) == 5
    reader.set_active_time_point(4)
    (block,) = reader.read()
    low, high = np.reshape(block.bounds, (3, 2)).T
    (end,) = drift.history("position", times=drift.t_end, of="dumbbell")["position"]
    assert np.all(low <= end)
    assert np.all(high >= end)
    assert set(block.cell_data["body"]) == {0, 1}
