"""A body is moved to what it meets first, and passes nothing: looked at by FCL, which has no part in it."""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, BoxBody, Plate
from nonsmooth.errors import DoubtfulDistance
from nonsmooth.interfaces import Body
from nonsmooth.model.overlaps import check_overlaps
from nonsmooth.placing.line import Line
from nonsmooth.placing.probe import Probe
from tests.engine.test_pairs import CONVEX
from tests.solids.kinds import KINDS, angle, random_turn

KNOWN = sorted(set(KINDS))
"""What FCL has a kind for."""


def _by_fcl(one: Body, two: Body, q: np.ndarray) -> float:
    """Return the distance of two bodies, 0 if they overlap, no number if FCL is in doubt."""
    try:
        return ns.distance(one, two, at=(None, (q[:3], q[3:])), by="fcl").gap
    except DoubtfulDistance:
        return np.nan
    except ns.NoDistance:
        return 0.0


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("pair", list(itertools.combinations_with_replacement(KNOWN, 2)), ids="-".join)
def test_no_kind_passes_another(build: Any, pair: tuple[str, str]) -> None:
    """From 5 cm off along any direction to a height: the distance is that, and was more on the way.

    From the place where they touch a run may start.
    """
    rng = np.random.default_rng(7)
    one, two = (KINDS[kind](rng) for kind in pair)
    system = ns.System([one, two])
    system.contact(one, two, **build.laws())
    probe = Probe.of(system, two)
    for height in (0.0, 0.002):
        way = rng.normal(size=3)
        way /= np.linalg.norm(way)
        start = np.concatenate([-0.05 * way + rng.uniform(-3e-3, 3e-3, 3), random_turn(rng)])
        probe.q[:] = start
        met = Line(probe, way, height).met()
        looked = []
        for part in (1.0, 0.99, 0.9, 0.6, 0.3):
            looked.append(_by_fcl(one, two, np.concatenate([start[:3] + part * (met - start)[:3], start[3:]])))
        assert np.isnan(looked[0]) or looked[0] == pytest.approx(height, abs=2e-9)
        assert not np.any(np.array(looked[1:]) <= height)
        probe.q[:] = met
        probe.gaps()
        check_overlaps(probe.model)


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("start", [0.045, 0.06, 0.1])
def test_a_box_lands_on_a_box(build: Any, start: float) -> None:
    """Not on the plate under it, from however far it comes; nor where there is no plate, nor with a height."""
    plate, low, high = Plate(), BoxBody(0.02, 0.02, 0.01), BoxBody(0.01, 0.01, 0.01)
    over, alone = ns.System([plate, low, high]), ns.System([low, high])
    for system in (over, alone):
        for one, two in itertools.combinations(system.bodies, 2):
            system.contact(one, two, **build.laws())
        system.place(low, position=(0.0, 0.0, 0.01))
        ns.touching(system, high, position=(0.0, 0.0, start))
        assert system.start(high)[0][2] == pytest.approx(0.03, abs=1e-14)
        ns.at_height(system, high, 0.002, position=(0.0, 0.0, start))
        assert system.start(high)[0][2] == pytest.approx(0.032, abs=1e-13)
        ns.touching(system, high, position=(0.0, 0.0, 0.015))
        assert system.start(high)[0][2] == pytest.approx(0.03, abs=1e-14)


def test_what_overlaps_goes_back_to_the_last_free_place(build: Any) -> None:
    """Out of one ball and through the next one, which is in the way; out of the inside of a mesh."""
    laws = build.laws()
    balls = [Ball(0.01) for _ in range(3)]
    system = ns.System(balls)
    for other in balls[:2]:
        system.contact(balls[2], other, **laws)
    system.place(balls[1], position=(0.0, 0.0, 0.03))
    ns.touching(system, balls[2], position=(0.0, 0.0, 0.001))
    assert system.start(balls[2])[0][2] == pytest.approx(0.05, abs=1e-14)
    ns.touching(system, balls[2], position=(0.0, 0.0, -0.001), direction=(0.0, 0.0, 1.0))
    assert system.start(balls[2])[0][2] == pytest.approx(-0.02, abs=1e-14)
    mesh, ball = angle(0.02), Ball(0.004)
    inside = ns.System([mesh, ball])
    inside.contact(mesh, ball, **laws)
    centre = mesh.frames[0][0].solid.surface.inner[0]  # type: ignore[union-attr]
    ns.touching(inside, ball, position=(centre[0], centre[1], 0.0))
    assert inside.start(ball)[0][2] == pytest.approx(0.014, abs=1e-14)


def test_a_ball_that_just_misses_passes(build: Any) -> None:
    """Both sides of the edge: by 1e-9 of the radii it touches, and beyond it goes on to the plate."""
    plate, one, two = Plate(), Ball(0.01), Ball(0.01)
    system = ns.System([plate, one, two])
    for first, second in itertools.combinations(system.bodies, 2):
        system.contact(first, second, **build.laws())
    system.place(one, position=(0.0, 0.0, 0.05))
    ns.touching(system, two, position=(0.02 * (1.0 - 1e-9), 0.0, 0.2))
    assert system.start(two)[0][2] == pytest.approx(0.05, abs=2e-6)
    ns.touching(system, two, position=(0.02 * (1.0 + 1e-9), 0.0, 0.2))
    assert system.start(two)[0][2] == pytest.approx(0.01, abs=1e-14)


@pytest.mark.fast_cases(6)
@pytest.mark.parametrize("pair", list(itertools.combinations_with_replacement(CONVEX, 2)), ids="-".join)
def test_bodies_that_were_made_to_touch_start_in_contact(build: Any, pair: tuple[str, str]) -> None:
    """Aligned along x and z, and turned at random: the distance and the least gap are zero, and a run begins."""
    rng = np.random.default_rng([8, *"-".join(pair).encode()])
    for way in (np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]), *rng.normal(size=(2, 3))):
        is_aligned = np.count_nonzero(way) == 1
        way /= np.linalg.norm(way)
        one, two = (CONVEX[kind]() for kind in pair)
        system = ns.System([one, two], gravity=0.0)
        system.contact(one, two, **build.laws())
        turn = (1.0, 0.0, 0.0, 0.0) if is_aligned else tuple(random_turn(rng))
        aside = np.zeros(3) if is_aligned else rng.uniform(-0.01, 0.01, 3)
        ns.touching(system, two, position=aside - 0.3 * way, orientation=turn, direction=way)
        q = system.start(two)[0]
        # rims that touch are set back by the feet
        set_back = sum(shape.solid.set_back for body in (one, two) for shape in body.frames[0] if shape.solid)
        assert -set_back - 1e-12 <= ns.distance(one, two, at=(None, (q[:3], q[3:]))).gap <= 1e-12
        solution = ns.simulate(system, 1e-4)
        assert solution.status == "done"
        gaps = solution.history("gap", times=0.0)["gap"]
        # two vertices have no contact
        assert np.nanmin(np.where(np.isfinite(gaps), gaps, np.nan)) >= -1e-12
