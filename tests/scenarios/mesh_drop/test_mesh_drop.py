"""The bracket and files of the user's: energy, penetration, momentum before the ground, rest, wrong input, figures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import nonsmooth as ns
from bodies.meshes.repair import MeshRepaired
from nonsmooth.engine.native.kernel import PLAIN
from scenarios.mesh_drop import MeshDrop
from tests.bodies.meshes import parts

pytestmark = pytest.mark.skipif(PLAIN, reason="full runs take minutes in plain mode")


@pytest.fixture(scope="module")
def run() -> tuple[MeshDrop, ns.Solution]:
    """Return the bracket, turning and drifting."""
    scenario = MeshDrop(spin=20.0, speed=0.3, t_end=0.5)
    return scenario, ns.simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval)


def test_energy_and_penetration(run: tuple[MeshDrop, ns.Solution]) -> None:
    scenario, solution = run
    assert solution.energy.residual < 1e-8
    assert np.min(scenario.lowest(solution)) > -1e-11
    for one in scenario.acceptance(solution):
        assert one.fulfilled, one
    summary = scenario.summarise(solution)
    assert summary["impacts"] > 10
    assert summary["volume_ratio"] == pytest.approx(scenario.body.mesh.volume_ratio)
    assert summary["friction_loss"] > 0.0


def test_it_comes_to_rest_on_three_corners_or_more(run: tuple[MeshDrop, ns.Solution]) -> None:
    """Nothing moves, the mass centre stands over the corners that touch."""
    scenario, solution = run
    assert np.max(np.abs(solution.u_end)) < 1e-7
    corners = scenario.corners(solution.q_end)
    on_ground = corners[corners[:, 2] < 1e-9]
    assert len(on_ground) >= 3
    low, high = np.min(on_ground, axis=0), np.max(on_ground, axis=0)
    assert np.all(solution.q_end[:2] >= low[:2])
    assert np.all(solution.q_end[:2] <= high[:2])


def test_in_the_air_it_keeps_its_angular_momentum(run: tuple[MeshDrop, ns.Solution]) -> None:
    """About the mass centre, in world axes, with all products of inertia; and it falls as anything does."""
    from bodies.inertia import tensor_of
    from nonsmooth.rotations import rotation

    scenario, solution = run
    flight = solution.t < 0.9 * np.sqrt(2.0 * scenario.height / 9.81)
    tensor = tensor_of(scenario.body.inertia, scenario.body.products)
    momenta = np.array(
        [rotation(q[3:7]) @ tensor @ u[3:] for q, u in zip(solution.q[flight], solution.u[flight], strict=True)]
    )
    size = float(np.linalg.norm(momenta[0]))
    np.testing.assert_allclose(momenta - momenta[0], 0.0, rtol=0, atol=1e-8 * size)
    assert np.max(np.abs(np.diff(solution.q[flight, 3:7], axis=0))) > 1e-4


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("form", ["stl", "obj", "ply", "off", "glb"])
def test_files_of_every_format_fall_alike(form: str, tmp_path: Path) -> None:
    """The same part in single precision or with the digits of a text, and in double."""
    trimesh = pytest.importorskip("trimesh")
    path = tmp_path / f"part.{form}"
    points, faces = parts.bracket()
    trimesh.Trimesh(1e3 * points, faces, process=False).export(str(path))
    scenario = MeshDrop(mesh=str(path), t_end=0.12, height=0.05)
    solution = ns.simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval)
    summary = scenario.summarise(solution)
    assert summary["extent"] == pytest.approx(0.03, rel=1e-6)
    assert summary["mass"] == pytest.approx(2700.0 * 6e-6, rel=1e-6)
    assert summary["corners"] == 10
    assert summary["first_impact"] == pytest.approx(np.sqrt(0.1 / 9.81), abs=1e-12)


def test_convex_files_too(tmp_path: Path) -> None:
    path = parts.write_stl(tmp_path / "box.stl", parts.box(20.0, 30.0, 50.0))
    scenario = MeshDrop(mesh=str(path), scale=2.0, t_end=0.5)
    solution = ns.simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval)
    for one in scenario.acceptance(solution):
        assert one.fulfilled, one
    assert scenario.summarise(solution)["mass"] == pytest.approx(2700.0 * 8.0 * 3e-5, rel=1e-6)
    # at rest on a face
    assert min(abs(solution.q_end[2] - half) for half in (0.02, 0.03, 0.05)) < 1e-8


def test_repairs_are_asked_for_and_told(tmp_path: Path) -> None:
    points, faces = parts.box(20.0, 30.0, 50.0)
    path = parts.write_stl(tmp_path / "open.stl", (points, faces[:-2]))
    with pytest.raises(ns.InvalidInput, match=r"open\.stl.*closed.*it is 4"):
        MeshDrop(mesh=str(path))
    with pytest.warns(MeshRepaired, match=r"open\.stl was repaired: holes: 1 holes closed"):
        scenario = MeshDrop(mesh=str(path), repair="merge, holes")
    assert scenario.body.total_mass == pytest.approx(2700.0 * 3e-5, rel=1e-6)


def test_wrong_input() -> None:
    with pytest.raises(ns.InvalidInput, match=r"mesh part\.stl must be a file"):
        MeshDrop(mesh="part.stl")
    with pytest.raises(ns.UnknownName, match="mm"):
        MeshDrop(unit="miles")


@pytest.mark.slow
def test_the_part_is_in_each_of_six_poses(run: tuple[MeshDrop, ns.Solution]) -> None:
    poses = MeshDrop.figures(*run)["poses"]
    assert len(poses.axes) == 6
    assert all(len(axes.collections) >= 4 for axes in poses.axes)
