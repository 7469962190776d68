"""Which piece is drawn of planes without end, and how much room a run takes."""

from __future__ import annotations

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, DrivenBody, Harmonic, OpenBox, Plate, Rest, Rod, Wall
from nonsmooth.histories.arrays import Floats
from nonsmooth.scene.extent import Extent, outlines
from nonsmooth.scene.scene import Scene


def _drawn(run: ns.Solution) -> tuple[Extent, list[Floats]]:
    """Return the extent of a run and the corners of its sheets in the world at its start."""
    states = run.at(np.linspace(0.0, run.t_end, 50))
    scene = Scene.of(run.system)
    origin, axes = scene.places(states.time, states["q"], states["u"])
    extent = Extent.of(scene, origin, axes)
    sheets = [part.frame for part in scene.parts if part.look.sheet]
    found = outlines(scene, origin, axes, extent)
    return extent, [origin[0, f] + flat @ axes[0, f, :, :2].T for f, flat in zip(sheets, found, strict=True)]


def _fall(*bodies: object, position: tuple[float, float, float] = (0.0, 0.0, 0.5)) -> ns.Solution:
    ball = Ball(0.02)
    system = ns.System([*bodies, ball])  # type: ignore[list-item]
    for body in bodies:
        system.exclude(body, ball)  # type: ignore[arg-type]
    system.place(ball, position=position)
    return ns.simulate(system, 0.3)


@pytest.mark.slow
def test_walls_of_a_box_meet_at_its_edges_and_are_as_high_as_the_motion() -> None:
    _, (floor, *walls) = _drawn(_fall(OpenBox(0.1, 0.2), position=(0.03, 0.0, 0.5)))
    half = np.array([0.1, 0.2, 0.0])
    np.testing.assert_allclose(floor.min(axis=0), -half, atol=1e-12)
    np.testing.assert_allclose(floor.max(axis=0), half, atol=1e-12)
    for wall, (axis, side) in zip(walls, [(0, -1), (0, 1), (1, -1), (1, 1)], strict=True):
        low, high = wall.min(axis=0), wall.max(axis=0)
        assert low[axis] == pytest.approx(side * half[axis])
        assert high[axis] == pytest.approx(side * half[axis])
        assert (low[1 - axis], high[1 - axis]) == pytest.approx((-half[1 - axis], half[1 - axis]))
        assert low[2] == pytest.approx(0.0, abs=1e-12)
        assert 0.52 < high[2] < 0.6


def test_a_wall_is_as_high_as_what_comes_to_it() -> None:
    slope = Wall(normal=(0.6, 0.0, 0.8))
    wall = Wall(normal=(-0.8, 0.0, 0.6), point=(0.8, 0.0, -0.6))
    ball = Ball(0.02)
    system = ns.System([slope, wall, ball], gravity=0.0)
    system.exclude(slope, ball)
    system.exclude(wall, ball)
    system.place(ball, position=(0.012, 0.0, 0.016), velocity=(1.6, 0.0, -1.2))
    _, corners = _drawn(ns.simulate(system, 0.3))
    height = corners[1] @ (0.6, 0.0, 0.8)
    assert np.min(height) == pytest.approx(0.0, abs=1e-12)
    assert 0.04 < np.max(height) < 0.1


def test_what_something_goes_behind_cuts_nothing() -> None:
    run = _fall(Plate(), Wall(normal=(1.0, 0.0, 0.0)), position=(-0.3, 0.0, 0.5))
    _, (floor, _) = _drawn(run)
    assert np.min(floor[:, 0]) < -0.3


def test_what_moves_beside_a_sheet_does_not_cut_it() -> None:
    run = _fall(Plate(Harmonic(0.01, 10.0)), Wall(normal=(1.0, 0.0, 0.0)), position=(0.3, 0.0, 0.5))
    _, (_, wall) = _drawn(run)
    assert np.min(wall[:, 2]) < -0.01


def test_a_sheet_that_another_hides_altogether_is_drawn_whole() -> None:
    _, (_, low) = _drawn(_fall(Plate(), Plate(Rest(position=(0.0, 0.0, -0.1)))))
    assert len(low) == 4
    np.testing.assert_allclose(low[:, 2], -0.1, atol=1e-15)


def test_a_sheet_counts_where_it_is_nearest_not_where_its_frame_is() -> None:
    extent, (floor,) = _drawn(_fall(Plate(Rest(position=(50.0, 0.0, 0.0)))))
    assert np.max(np.abs(extent.high)) < 0.6
    assert extent.low[2] == pytest.approx(0.0, abs=1e-12)
    assert np.max(np.abs(floor)) < 0.1


def test_a_rod_takes_no_more_room_than_it_has() -> None:
    rod = Rod(0.4, 0.01)
    system = ns.System([DrivenBody(), rod], gravity=0.0)
    system.place(rod, position=(0.2, 0.0, 0.0))
    extent, _ = _drawn(ns.simulate(system, 0.1))
    np.testing.assert_allclose(extent.low, (-0.01, -0.01, -0.01), atol=1e-3)
    np.testing.assert_allclose(extent.high, (0.41, 0.01, 0.01), atol=1e-3)
    assert extent.reach == pytest.approx(0.21, abs=1e-3)
