"""Orbits modulo turns: the dumbbell that circles, and a ball that spins."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest

import nonsmooth as ns
from bodies import PlanarBody, Plate
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.rotations import rotation
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.orbits.branch import continuation
from nonsmooth.studies.orbits.periodic import NoOrbit, Orbit, orbit
from nonsmooth.studies.orbits.symmetries import Spin, Turn
from scenarios.bouncing_ball import BouncingBall
from scenarios.dumbbell import DumbbellScenario

pytestmark = pytest.mark.skipif(PLAIN, reason="hundreds of runs take minutes in plain mode")
E, PERIOD = 0.8, 0.04
ALL = ("z", "rx", "ry", "rz", "vx", "vy", "vz", "wx", "wy", "wz")
ROLLS = (Turn(), Spin("dumbbell", "x"))


@pytest.fixture(scope="module")
def circling() -> Orbit:
    scenario = DumbbellScenario(mode="drift", transverse_velocity=1.0)
    return orbit(scenario, PERIOD, settle=4.0, within=ALL, symmetries=ROLLS)


@pytest.mark.slow
def test_the_dumbbell_circles(circling: Orbit) -> None:
    """A run that nobody turns back has the heading and the path that the orbit says."""
    assert circling.residual < 1e-12
    assert circling.stable
    turn, spin = circling.turns.values()
    n = 100
    start, model = circling.state, circling.family.model()
    run = model.run(start.time + n * PERIOD, start=start, sample_interval=PERIOD)
    rods = np.array([rotation(q[3:7])[:, 0] for q in run.q])
    headings = np.unwrap(np.arctan2(rods[:, 1], rods[:, 0]))
    np.testing.assert_allclose(np.diff(headings), turn, atol=1e-9)
    np.testing.assert_allclose(rods[:, 2], rods[0, 2], atol=1e-9)
    # chords of a circle: of one length, each turned from the one before
    chords = np.diff(run.q[:, 0] + 1j * run.q[:, 1])
    np.testing.assert_allclose(chords[1:] / chords[:-1], cmath.exp(1j * turn), atol=1e-7)
    assert spin == pytest.approx(0.417621407, abs=1e-7)


@pytest.mark.slow
def test_it_is_followed_along_a_parameter(circling: Orbit) -> None:
    """More friction turns it faster, either way from where it was found."""
    branch = continuation(circling, "friction", (0.199, 0.201), most=2)
    assert branch.ending == "2 steps; 2 steps"
    turns = [next(iter(one.turns.values())) for one in (branch.orbits[0], circling, branch.orbits[-1])]
    assert turns[0] > turns[1] > turns[2]
    for one in branch.orbits:
        assert one.residual < 1e-11


@pytest.mark.slow
def test_a_plane_motion_has_its_multipliers_in_space_as_well() -> None:
    """Besides those of motions out of the plane."""
    scenario = DumbbellScenario(mode="drift")
    plane = orbit(scenario, PERIOD, settle=4.0, within=("z", "ry", "vy", "vz", "wy"))
    space = orbit(scenario, PERIOD, settle=4.0, within=ALL, symmetries=ROLLS)
    assert max(map(abs, space.turns.values())) < 1e-9
    for value in plane.multipliers[:3]:
        assert np.min(np.abs(space.multipliers - value)) < 1e-6


def _spinning(turns: float) -> ns.System:
    system = BouncingBall(gamma=0.8, restitution=E).build()
    ball = system.bodies[1]
    q, u = system.start(ball)
    system.set_start(ball, q, np.concatenate([u[:3], [0.0, 0.0, 2.0 * math.pi * turns / PERIOD]]))
    return system


@pytest.mark.slow
def test_a_ball_that_spins_about_the_vertical() -> None:
    """What it is tilted by turns on, seen from a frame that turns with it."""
    family = Family(_spinning, {"turns": 0.3})
    found = orbit(family, PERIOD, within=("z", "vz", "rx", "ry", "rz"), symmetries=(Turn(),))
    angle = 2.0 * math.pi * 0.3
    assert found.turns == pytest.approx({"turn about (0, 0, 1)": angle}, abs=1e-12)
    for value in (cmath.exp(1j * angle), cmath.exp(-1j * angle)):
        assert np.min(np.abs(found.multipliers - value)) < 1e-9
    assert sorted(np.abs(found.multipliers)) == pytest.approx([E, E, 1.0, 1.0], abs=1e-9)
    with pytest.raises(NoOrbit):
        orbit(family, PERIOD, within=("z", "vz", "rx", "ry", "rz"))


@pytest.mark.slow
def test_what_is_refused(circling: Orbit) -> None:
    scenario = circling.family
    with pytest.raises(ns.InvalidInput, match=r"Spin\.axis.*'w'"):
        Spin("dumbbell", "w")
    with pytest.raises(ns.InvalidInput, match=r"Turn\.axis must be a direction"):
        Turn((0.0, 0.0, 0.0))
    with pytest.raises(ns.InvalidInput, match=r"Spin\.body.*Did you mean 'dumbbell'"):
        orbit(scenario, PERIOD, within=ALL, symmetries=(Spin("dumbell", "x"),))
    # the dumbbell has no symmetry about an axis across its rod, and gravity none about a level one
    with pytest.raises(ns.InvalidInput, match=r"must be one of the system, but .*spin of dumbbell about its z"):
        orbit(scenario, PERIOD, start=circling.state, within=ALL, symmetries=(Turn(), Spin("dumbbell", "z")))
    with pytest.raises(ns.InvalidInput, match=r"must be one of the system, but .*turn about \(1, 0, 0\)"):
        orbit(scenario, PERIOD, start=circling.state, within=ALL, symmetries=(Turn((1.0, 0.0, 0.0)),))
    with pytest.raises(ns.InvalidInput, match="need a section with all contacts open"):
        orbit(scenario, PERIOD, start=circling.state, at=0.0005, within=ALL, symmetries=ROLLS)


def test_bodies_that_are_not_free_in_space_are_refused() -> None:
    system = ns.System([Plate(), PlanarBody(1.0, 1.0)])
    with pytest.raises(ns.InvalidInput, match="'planar body' must be free in space"):
        orbit(system, 1.0, symmetries=(Turn(),))
