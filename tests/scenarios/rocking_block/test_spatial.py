"""The spatial block: planar where it should be, Housner's ratio on an edge, rocking on corners."""

from __future__ import annotations

import math

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.engine.memory.modes import Cause
from scenarios.rocking_block import RockingBlock, RockingBlock3D, housner

FINE = ns.EventDriven(tolerance=1e-12, impact_tolerance=1e-12)


@pytest.mark.parametrize(("restitution", "friction", "t_end"), [(0.8, 0.0, 1.2), (0.3, 1.5, 0.8)])
def test_on_an_edge_as_in_the_plane(restitution: float, friction: float, t_end: float) -> None:
    """Started over an edge it moves as the planar block: the same times, velocities and samples."""
    common = {"base": 1.0, "height": 0.5, "restitution": restitution, "friction": friction, "t_end": t_end}
    flat = RockingBlock(tilt=0.5, **common)
    deep = RockingBlock3D(depth=0.4, direction=0.0, tilt=0.5, **common)
    one = ns.simulate(flat.build(), t_end, engine=FINE)
    two = ns.simulate(deep.build(), t_end, engine=FINE)
    times = [run.events.time[run.events.cause == Cause.IMPACT] for run in (one, two)]
    assert len(times[0]) >= 3
    # equal and opposite corners may strike within the time tolerance, not at the very same instant
    assert np.max(np.min(np.abs(times[1][:, None] - times[0]), axis=1)) <= 1e-8
    np.testing.assert_allclose(two.q[:, [0, 2]], one.q[:, :2], rtol=0, atol=1e-8)
    np.testing.assert_allclose(deep.lean(two)[:, 0], np.sin(one.q[:, 2]), rtol=0, atol=1e-8)
    assert np.max(np.abs(two.q[:, 1])) <= 1e-9


def test_velocity_ratio_on_an_edge() -> None:
    """Two corners at a time strike and stick: Housner's ratio again."""
    alpha = 0.3
    friction = 1.1 * housner.least_friction(alpha)
    block = RockingBlock3D(base=math.tan(alpha), depth=0.5, direction=0.0, tilt=0.05, friction=friction, t_end=0.5)
    solution = ns.simulate(block.build(), block.t_end, engine=FINE)
    first = np.flatnonzero(solution.events.cause == Cause.IMPACT)[0]
    assert solution.events.words("during")[first] == "{01010101,01010000,00000000}"
    ratio = solution.events.u_after[first, 4] / solution.events.u_before[first, 4]
    assert ratio == pytest.approx(housner.velocity_ratio(alpha), abs=1e-9)


def test_rocking_on_corners() -> None:
    """From a corner it rocks over others in turn; the account closes, no corner sinks in, the tilt dies down."""
    block = RockingBlock3D(t_end=1.5)
    solution = ns.simulate(block.build(), block.t_end, sample_interval=block.sample_interval)
    assert solution.energy.residual <= 1e-7
    heights = block.corner_heights(solution)
    assert np.min(heights) >= -1e-9
    on_ground = heights <= 1e-9
    assert np.all(on_ground.any(axis=0))
    assert np.mean(on_ground.sum(axis=1) == 1) > 0.9
    summary = block.summarise(solution)
    # the second group of a mode word says who approaches: one corner at a time
    assert [impact["mode"].split(",")[1].count("1") for impact in summary["first_impacts"]] == [1] * 5
    assert summary["restitution_loss"] > 0.0
    lean = np.hypot(*block.lean(solution).T)
    assert lean[0] == pytest.approx(math.sin(block.tilt), abs=1e-12)
    assert np.max(lean[solution.t > 1.0]) < 0.7 * lean[0]


def test_mirror_image() -> None:
    """Tilted towards -y instead of +y, it moves as its mirror image."""
    one, two = (RockingBlock3D(direction=direction, t_end=0.7) for direction in (0.7, -0.7))
    runs = [ns.simulate(block.build(), block.t_end, engine=FINE) for block in (one, two)]
    np.testing.assert_allclose(one.lean(runs[0]), one.lean(runs[1]) * [1.0, -1.0], rtol=0, atol=1e-8)
    assert np.max(np.abs(one.lean(runs[0])[:, 1])) > 0.05


@pytest.mark.slow
def test_coordinates_and_end_agree() -> None:
    block = RockingBlock3D(t_end=0.5)
    solution = ns.simulate(block.build(), block.t_end)
    coordinates = block.coordinates(solution)
    assert [coordinates[name][-1] for name in "xyz"] == pytest.approx(block.final(solution)["q"][:3])
