"""A GLB file tells where the bodies were, and keeps the rules of glTF."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Ball, DrivenBody, Hinge, HullBody, Plate, Rod, Spring
from nonsmooth.export.film import Film
from tests.export.glb_read import Read

_CHECK = """
const { validateBytes } = require("gltf-validator");
const data = new Uint8Array(require("fs").readFileSync(process.argv[1]));
validateBytes(data).then((found) => console.log(JSON.stringify(found.issues)));
"""

_POSE = ("position", "rotation")
_IMPULSES = ("impulse_contact", "normal_impulse", "friction_impulse", "impulse_point")


def _read(run: ns.Solution, tmp_path: Path, **options: int) -> Read:
    return Read(run.export(tmp_path / "run.glb", **options).read_bytes())


def test_tracks_are_the_poses_of_the_run(drift: ns.Solution, tmp_path: Path) -> None:
    found = _read(drift, tmp_path)
    times, places = found.track("dumbbell", "translation")
    assert np.all(np.diff(times) > 0.0)
    assert np.all(np.isin(drift.events.time.astype(np.float32), times))
    poses = drift.history(*_POSE, times=np.minimum(times.astype(float), drift.t_end), of="dumbbell")
    # keys of 32 bits are 1e-8 s off
    np.testing.assert_allclose(places, poses["position"][:, 0], rtol=0.0, atol=1e-7)
    turned = Rotation.from_quat(found.track("dumbbell", "rotation")[1]).inv() * Rotation.from_matrix(
        poses["rotation"][:, 0]
    )
    assert np.max(turned.magnitude()) < 1e-5


def test_turns_go_the_short_way(tmp_path: Path) -> None:
    box = HullBody([(x, y, z) for x in (-0.1, 0.1) for y in (-0.2, 0.2) for z in (-0.3, 0.3)])
    system = ns.System([box], gravity=0.0)
    system.place(box, position=(0.0, 0.0, 0.0), angular_velocity=(20.0, 3.0, 1.0))
    _, turns = _read(ns.simulate(system, 1.0), tmp_path).track("hull", "rotation")
    np.testing.assert_allclose(np.linalg.norm(turns, axis=1), 1.0, atol=1e-6)
    assert np.min(np.einsum("ij,ij->i", turns[1:], turns[:-1])) > 0.99
    assert np.min(turns @ turns[0]) < -0.9


def test_a_spring_is_as_long_as_it_is(tmp_path: Path) -> None:
    box = HullBody([(x, y, z) for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (-0.1, 0.1)])
    system = ns.System([Plate(), box])
    spring = Spring(200.0, 1.0, first=(0.0, 0.0, 2.0), second=(0.0, 0.0, 0.1))
    system.load(spring, system.bodies[0], box)
    system.place(box, position=(0.2, 0.0, 1.0), angular_velocity=(1.0, 2.0, 3.0))
    run = ns.simulate(system, 0.5)
    found = _read(run, tmp_path)
    name = system.loads[0].name
    times, scales = found.track(name, "scale")
    poses = run.history(*_POSE, times=np.minimum(times.astype(float), run.t_end), of=box)
    ends = poses["position"][:, 0] + poses["rotation"][:, 0] @ [0.0, 0.0, 0.1]
    lengths = np.linalg.norm(ends - [0.0, 0.0, 2.0], axis=1)
    np.testing.assert_allclose(scales[:, 0], lengths, rtol=1e-6)
    np.testing.assert_array_equal(scales[:, 1:], 1.0)
    _, turns = found.track(name, "rotation")
    along = Rotation.from_quat(turns).apply([1.0, 0.0, 0.0])
    np.testing.assert_allclose(along * lengths[:, None], ends - [0.0, 0.0, 2.0], atol=1e-6)


def test_a_joint_is_a_dot_that_goes_with_its_bodies() -> None:
    base, rod = DrivenBody(), Rod(0.3, 0.005)
    system = ns.System([base, rod])
    system.joint(Hinge((0.0, 0.0, 0.0), (-0.15, 0.0, 0.0)), base, rod)
    system.place(rod, position=(0.15, 0.0, 0.0))
    film = Film.of(ns.simulate(system, 0.5), np.array([0.0, 0.4]))
    (dot,) = (piece for piece in film.pieces if piece.body < 0)
    for i in range(2):
        np.testing.assert_allclose(film.placed(dot, i).mean(axis=0), 0.0, atol=1e-3)


def test_a_sheet_that_slides_in_itself_stays(arm: ns.Solution, tmp_path: Path) -> None:
    found = _read(arm, tmp_path)
    belt = next(body for body in arm.system.bodies if body.n_u == 0 and body.frames)
    moved = [c for c in found.told["animations"][0]["channels"] if c["target"]["path"] == "translation"]
    assert found.node(arm.system.name_of(belt)) not in [channel["target"]["node"] for channel in moved]


def test_nearest_instants_become_one_key(drift: ns.Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of those that 32 bits do not tell apart the last one is kept."""
    instants = np.array([0.0, 0.2, 0.2 + 1e-10, 0.2 + 2e-10, 0.3])
    monkeypatch.setattr("nonsmooth.export.glb.knots", lambda *_: instants)
    times, places = _read(drift, tmp_path).track("dumbbell", "translation")
    np.testing.assert_array_equal(times, instants[[0, 3, 4]].astype(np.float32))
    (there,) = drift.history("position", times=instants[3], of="dumbbell")["position"]
    np.testing.assert_array_equal(places[1], there.astype(np.float32))


def test_fewer_knots_make_a_smaller_file(drift: ns.Solution, tmp_path: Path) -> None:
    large = drift.export(tmp_path / "large.glb").stat().st_size
    small = drift.export(tmp_path / "small.glb", most_knots=10).stat().st_size
    assert small < large
    with pytest.raises(ns.InvalidInput, match=r"export: most_knots must be .*1"):
        drift.export(tmp_path / "none.glb", most_knots=1)


def test_normals_are_units_outwards_and_colours_whole(cradle: ns.Solution, tmp_path: Path) -> None:
    found = _read(cradle, tmp_path)
    for mesh in found.told["meshes"][:5]:
        attributes = mesh["primitives"][0]["attributes"]
        corners, normals, colours = (found.array(attributes[name]) for name in ("POSITION", "NORMAL", "COLOR_0"))
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-6)
        outward = corners / np.linalg.norm(corners, axis=1)[:, None]
        assert np.min(np.einsum("ij,ij->i", normals, outward)) > 0.95
        assert np.all(colours[:, 3] == 255)
        accessor = found.told["accessors"][attributes["POSITION"]]
        np.testing.assert_array_equal(accessor["min"], corners.min(axis=0))
        np.testing.assert_array_equal(accessor["max"], corners.max(axis=0))


def test_arrows_are_the_impulses_while_they_last(drift: ns.Solution, tmp_path: Path) -> None:
    """Just behind each impact as long as its impulse, beginning where it acts; before the first one there is none."""
    found, impulses = _read(drift, tmp_path), drift.history(*_IMPULSES)
    contact, normal, friction, points = impulses.values()
    name = drift.system.contacts[0].name
    times, sizes = found.track(f"impulse {name}", "scale")
    _, places = found.track(f"impulse {name}", "translation")
    own = np.flatnonzero((contact == 0) & (normal > 0.0))
    # the last of those that share an instant
    own = own[np.append(np.diff(impulses.time[own]) > 0.0, True)]
    keys = np.searchsorted(times, impulses.time[own].astype(np.float32))
    true = np.hypot(normal, np.linalg.norm(friction, axis=1))
    np.testing.assert_allclose(sizes[keys, 0] / sizes[keys[0], 0], true[own] / true[own[0]], rtol=1e-5)
    np.testing.assert_allclose(places[keys], points[own].mean(axis=1), atol=1e-7)
    if keys[0] > 0:
        assert np.all(sizes[0] == 0.0)


def test_others_read_it(drift: ns.Solution, tmp_path: Path) -> None:
    """The place of the bodies at the beginning, with y upwards, by trimesh."""
    scene = trimesh.load(drift.export(tmp_path / "run.glb"))
    first = drift.history("position", times=0.0, of="dumbbell")["position"][0]
    nodes = [scene.graph.get(name) for name in scene.graph.nodes_geometry]
    places = np.array([matrix[:3, 3] for matrix, _ in nodes])
    assert np.min(np.linalg.norm(places - [first[0], first[2], -first[1]], axis=1)) < 1e-6


def test_without_motion_there_is_no_animation(tmp_path: Path) -> None:
    ball = Ball(0.1)
    found = _read(ns.simulate(ns.System([ball], gravity=0.0), 0.1), tmp_path)
    assert "animations" not in found.told


@pytest.mark.skipif(
    shutil.which("npm") is None or "CI" not in os.environ, reason="fetches the validator: where CI is set"
)
def test_the_validator_of_khronos_finds_nothing(
    drift: ns.Solution, arm: ns.Solution, cradle: ns.Solution, tmp_path: Path
) -> None:
    words = ["npm", "install", "--ignore-scripts", "--no-audit", "gltf-validator@2.0.0-dev.3.10"]
    subprocess.run(words, cwd=tmp_path, check=True, capture_output=True)
    for run in (drift, arm, cradle):
        path = run.export(tmp_path / "run.glb")
        told = subprocess.run(["node", "-e", _CHECK, path], cwd=tmp_path, check=True, capture_output=True).stdout
        issues = json.loads(told)
        assert issues["messages"] == []
