"""Orbits of systems without a period of their own: a hopper in closed form, and the woodpecker.

The hopper is thrown off the floor against gravity g, with a thrust of c times its velocity: with g and c at 1 its
flight from the speed v has the velocity 1 - (1 - v) exp(t); an impact that takes away what it has gained makes an
orbit.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import nonsmooth as ns
from bodies import Coordinate, GeneralisedBody, PlanarBody, Plate, Point, PointFrame
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.studies.derivatives.family import EXACT, Family
from nonsmooth.studies.orbits.branch import continuation
from nonsmooth.studies.orbits.linear import linear
from nonsmooth.studies.orbits.periodic import NoOrbit, Orbit, orbit
from nonsmooth.studies.orbits.sections import PoincareSection, StroboscopicSection
from nonsmooth.types import Floats
from scenarios.woodpecker import Woodpecker

pytestmark = pytest.mark.skipif(PLAIN, reason="hundreds of runs take minutes in plain mode")
TOP = PoincareSection("z rate", rising=False, longest=5.0)
CYCLE = ("phi_m", "phi_s", "y rate", "phi_m rate", "phi_s rate")


def _mass(q: Floats, out: Floats) -> None:
    out[0] = 1.0


def _force(t: float, q: Floats, u: Floats, out: Floats) -> None:
    out[0] = u[0] - 1.0


def _potential(q: Floats) -> float:
    return q[0]


def _power(t: float, q: Floats, u: Floats) -> float:
    return u[0] * u[0]


def _foot(q: Floats, out: Floats) -> None:
    out[2] = q[0]


def _foot_jacobian(q: Floats, out: Floats) -> None:
    out[2] = 1.0


def _no_bias(q: Floats, u: Floats, out: Floats) -> None:
    pass


def _hopper(restitution: float, height: float) -> ns.System:
    body = GeneralisedBody(
        coordinates=(Coordinate("z", "m", height),),
        mass=_mass,
        force=_force,
        potential=_potential,
        power=_power,
        moving_frames=(PointFrame(_foot, _foot_jacobian, _no_bias, (Point(),)),),
    )
    floor = Plate()
    system = ns.System([body, floor], gravity=0.0)
    impact = EnergeticImpact(restitution)
    system.contact(body, floor, normal=Unilateral(), friction=Frictionless(), impact=impact)
    return system


def _closed_form(period: float) -> tuple[float, float, float, float]:
    """Return speed off the floor, restitution, height and multiplier of the orbit of a period."""
    grown = math.exp(period)
    speed = 1.0 - period / (grown - 1.0)
    back = 1.0 - (1.0 - speed) * grown
    # how much later a faster one comes back, and how fast then
    later = -(grown - 1.0) / back
    multiplier = -speed / -back * (grown - (1.0 - speed) * grown * later)
    rise = -math.log(1.0 - speed)
    return speed, speed / -back, rise - (1.0 - speed) * (math.exp(rise) - 1.0), multiplier


def _hops(period: float) -> Orbit:
    _, restitution, height, _ = _closed_form(period)
    family = Family(_hopper, {"restitution": restitution, "height": 0.98 * height})
    return orbit(family, section=TOP, within=("z", "z rate"))


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("period", [0.5, 1.0, 1.7])
def test_an_unstable_orbit_in_closed_form(period: float) -> None:
    """Period, height and the only multiplier there is within the section."""
    _, _, height, multiplier = _closed_form(period)
    found = _hops(period)
    assert found.map.chart.names == ("generalised.z",)
    assert found.period == pytest.approx(period, abs=1e-11)
    assert found.state.q[0] == pytest.approx(height, abs=1e-11)
    assert found.multipliers == pytest.approx([multiplier], abs=1e-9)
    assert not found.stable
    assert "besides 1 along the motion, which the section of generalised.z rate takes away" in str(found)


@pytest.mark.slow
def test_it_is_followed() -> None:
    """The period grows as the impact takes more away."""
    branch = continuation(_hops(1.0), "restitution", (0.65, 0.8), most=4)
    assert branch.special == ()
    assert len(branch.orbits) == 9
    for value, found in zip(branch.values, branch.orbits, strict=True):
        period = brentq(lambda T, e=value: _closed_form(T)[1] - e, 0.1, 3.0, xtol=1e-14)
        assert found.period == pytest.approx(period, abs=1e-9)


def _woodpecker() -> Orbit:
    return orbit(Woodpecker(), section=PoincareSection("phi_m"), settle=2.0, within=CYCLE)


@pytest.mark.slow
def test_the_woodpecker_pecks_its_way_down() -> None:
    """Glocker (1995): a limit cycle of about 0.146 s and 19.5 mm, here as it goes on when it has settled for long.

    Of two successive intervals between pecks the deviations have the ratio of the largest multiplier.
    """
    found = _woodpecker()
    assert found.residual < 1e-11
    assert found.period == pytest.approx(0.146, abs=5e-4)
    descent = found.state.q[0] - found.map.end.state.q[0]
    assert descent == pytest.approx(19.5e-3, abs=1e-4)
    scenario = Woodpecker(t_end=12.0)
    times, heights = scenario.pecks(ns.simulate(scenario.build(), 12.0, sample_interval=1.0, engine=EXACT))
    intervals = np.diff(times)
    assert np.mean(intervals[-2:]) == pytest.approx(found.period, abs=1e-7)
    assert (heights[-3] - heights[-1]) / 2.0 == pytest.approx(descent, abs=1e-7)
    off = np.abs(intervals - found.period)
    late = np.flatnonzero((off < 1e-4) & (off > 1e-7))
    ratios = (intervals[late + 1] - found.period) / (intervals[late] - found.period)
    assert len(ratios) > 10
    assert ratios[-1] == pytest.approx(found.multipliers[0].real, abs=1e-4)


def test_parameters_keep_their_units() -> None:
    assert PoincareSection("phi_m").guarded(Family.of(Woodpecker())).label("bird_arm") == "bird_arm [m]"


@pytest.mark.slow
def test_the_section_takes_the_multiplier_1_away() -> None:
    """After a fixed time the same perturbations have the same multipliers, and 1 along the motion."""
    found = _woodpecker()
    model = Family.of(Woodpecker()).model()
    start = ns.State.at(model.system, found.state.time, found.state.q, found.state.u)
    after = linear(model, start, StroboscopicSection(found.period), CYCLE)
    values = np.linalg.eigvals(after.matrix)
    assert len(values) == len(found.multipliers) + 1
    large = sorted(values[np.abs(values) > 1e-3].real)
    assert large == pytest.approx([found.multipliers[0].real, 1.0], abs=1e-6)


def _rolling_prism() -> ns.System:
    """Return a hexagonal prism that rolls down a plane of 10 degrees, from edge to edge."""
    slope, size = math.radians(10.0), 0.1
    edges = tuple(Point(size * math.sin(k * math.pi / 3), 0.0, -size * math.cos(k * math.pi / 3)) for k in range(6))
    plane, prism = Plate(), PlanarBody(1.0, 5.0 / 12.0 * size**2, edges)
    system = ns.System([plane, prism], gravity=(9.81 * math.sin(slope), 0.0, -9.81 * math.cos(slope)))
    system.contact(plane, prism, normal=Unilateral(), friction=Coulomb(1.0), impact=EnergeticImpact(0.0))
    system.place(prism, position=(0.0, size), velocity=(6.0 * size, 0.0), angular_velocity=6.0)
    return system


def test_edges_that_take_turns_repeat_after_a_whole_turn() -> None:
    """Each impact leaves 11/17 of the spin (International Physics Olympiad 1998)."""
    system = _rolling_prism()
    with pytest.raises(NoOrbit, match=r"\(1\)' is closed and sticks at the start .* open at its end; .*times=n"):
        orbit(system, section=PoincareSection("z", 0.095), settle=3.0, within=("z", "vx", "vz", "w"))
    turn = PoincareSection("z", 0.095, times=6)
    found = orbit(system, section=turn, settle=3.0, within=("z", "vx", "vz", "w"))
    assert found.multipliers == pytest.approx([(11.0 / 17.0) ** 12], abs=1e-9)
    assert found.map.end.state.q[2] - found.state.q[2] == pytest.approx(2.0 * math.pi, abs=1e-9)


def test_what_closed_contacts_hold_must_repeat_too() -> None:
    """Without its velocities the spin of a prism on an edge counts as held, and nothing is left that is free."""
    with pytest.raises(NoOrbit, match=r"that closed contacts hold differ by .*add those that they depend on"):
        orbit(_rolling_prism(), section=PoincareSection("z", 0.095, times=6), settle=1.0, within=("angle", "w"))


def test_what_is_no_section() -> None:
    _, restitution, height, _ = _closed_form(1.0)
    family = Family(_hopper, {"restitution": restitution, "height": height})
    with pytest.raises(ns.InvalidInput, match=r"must pass 2 upwards within 1 s"):
        orbit(family, section=PoincareSection("z", 2.0, longest=1.0))
    with pytest.raises(ns.InvalidInput, match="must be given, or a section in its place"):
        orbit(family)
    with pytest.raises(ns.InvalidInput, match="must be given, or a section in its place"):
        orbit(family, 1.0, section=TOP)
    with pytest.raises(ns.InvalidInput, match=r"'zz'\. Known: generalised\.work, generalised\.z, "):
        orbit(family, section=PoincareSection("zz"))
    with pytest.raises(ns.InvalidInput, match=r"PoincareSection\.times must be positive"):
        PoincareSection("z", times=0)
    with pytest.raises(NoOrbit, match="leads to a state from which no run comes back to the section"):
        # it falls asleep on the floor
        orbit(family.at(height=0.2 * height), section=TOP)
