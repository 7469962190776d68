"""The dumbbell out of meshes: nearer to the one with balls with more triangles, and its picture."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.engine.native.kernel import PLAIN
from scenarios.mesh_dumbbell.ball import ball
from scenarios.mesh_dumbbell import MeshDumbbell


@pytest.mark.parametrize("subdivisions", [0, 1, 2])
def test_balls_of_triangles_are_closed_with_all_corners_on_the_ball(subdivisions: int) -> None:
    mesh = ball(0.01, subdivisions).mesh
    assert len(mesh.faces) == 20 * 4**subdivisions
    assert mesh.is_convex
    np.testing.assert_allclose(np.linalg.norm(mesh.vertices, axis=1), 0.01, rtol=1e-14)


def test_half_triangles_are_refused() -> None:
    with pytest.raises(ns.InvalidInput, match=r"whole number, but it is 1\.5"):
        MeshDumbbell(subdivisions=1.5)


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="minutes in plain mode")
def test_more_triangles_are_nearer(tmp_path: Path) -> None:
    """The second impact is late by less; what is drawn is what the summary says."""
    late = []
    for subdivisions in (0.0, 1.0, 3.0):
        scenario = MeshDumbbell(subdivisions=subdivisions, t_end=0.05)
        solution = ns.simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval)
        summary = scenario.summarise(solution)
        late.append(summary["delays"][1])
        assert summary["distance_at_end"] < 2e-3
        gaps = scenario.gaps(solution.t, solution.q, meshes=True)
        assert np.min(gaps) > -1e-9
        start = scenario.gaps(solution.t[:1], solution.q[:1], meshes=False)
        np.testing.assert_allclose(start[0, 0], 0.0, atol=1e-15)
    assert late[0] > late[1] > late[2] > 1e-4
    for name, figure in scenario.figures(solution).items():
        figure.savefig(tmp_path / f"{name}.png")
        assert (tmp_path / f"{name}.png").stat().st_size > 10000
