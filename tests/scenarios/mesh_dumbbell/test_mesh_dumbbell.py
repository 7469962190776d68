"""The dumbbell out of meshes: nearer to the one with balls with more triangles."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.engine.native.kernel import PLAIN
from scenarios.mesh_dumbbell import MeshDumbbell, ball_of_triangles


@pytest.mark.parametrize("subdivisions", [0, 1, 2])
def test_balls_of_triangles_are_closed_with_all_corners_on_the_ball(subdivisions: int) -> None:
    mesh = ball_of_triangles(0.01, subdivisions).mesh
    assert len(mesh.faces) == 20 * 4**subdivisions
    assert mesh.is_convex
    np.testing.assert_allclose(np.linalg.norm(mesh.vertices, axis=1), 0.01, rtol=1e-14)


def test_half_triangles_are_refused() -> None:
    with pytest.raises(ns.InvalidInput, match=r"an integer, but it is 1\.5"):
        MeshDumbbell(**dict[str, Any](subdivisions=1.5))


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="minutes in plain mode")
def test_more_triangles_are_nearer() -> None:
    """The second impact is late by less."""
    late = []
    for subdivisions in (0, 1, 3):
        scenario = MeshDumbbell(subdivisions=subdivisions, t_end=0.05)
        solution = ns.simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval)
        summary = scenario.summarise(solution)
        np.testing.assert_array_equal(scenario.with_balls().t, solution.t)
        late.append(summary["delays"][1])
        assert summary["distance_at_end"] < 2e-3
        gaps = scenario.gaps(solution.t, solution.q, meshes=True)
        assert np.min(gaps) > -1e-9
        start = scenario.gaps(solution.t[:1], solution.q[:1], meshes=False)
        np.testing.assert_allclose(start[0, 0], 0.0, atol=1e-15)
    assert late[0] > late[1] > late[2] > 1e-4
