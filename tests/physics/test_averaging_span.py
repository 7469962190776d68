"""A light disc under a heavy body that rolls over it: contact points run along the disc within a contact time.

Forces constant over a contact time would lead the disc apart from the bodies that press it, or into them.  They are
averaged over less there.
"""

from __future__ import annotations

import numpy as np
import pytest

import nonsmooth as ns
from bodies import CylinderBody, DiscBody, Plate, SuperellipsoidBody
from laws import Coulomb, Directional, EnergeticImpact, Unilateral
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.histories.distances import distances
from nonsmooth.interfaces import FrictionLaw

T_END, CONTACT_TIME = 0.1333, 2e-5
DISC = DiscBody(radius=4.529e-3, surface_density=1.0)
ROLLER = SuperellipsoidBody(
    semi_x=8.649e-3, semi_y=11e-3, semi_z=9.903e-3, exponent_along=0.6481, exponent_across=0.5502, density=7800.0
)


def _build(friction: FrictionLaw = Coulomb(0.3)) -> ns.System:  # noqa: B008 (a law is a constant)
    plate = Plate()
    system = ns.System([plate, DISC, ROLLER])
    law = EnergeticImpact(0.5, exponent=1.5, duration=CONTACT_TIME)
    for one, other in ((plate, DISC), (plate, ROLLER), (DISC, ROLLER)):
        system.contact(one, other, normal=Unilateral(), friction=friction, impact=law)
    ns.touching(
        system,
        DISC,
        position=(-0.017, -0.00013, 0.0077),
        orientation=(0.26979205098867126, -0.886019064244683, 0.10968714413548386, 0.3607647397261876),
    )
    ns.touching(
        system,
        ROLLER,
        position=(-0.01, -0.0097, 0.024),
        orientation=(0.2577927450998145, -0.5997504308540144, -0.6725428611981925, 0.34860926711100937),
        angular_velocity=(-16.0, 35.0, 18.0),
    )
    return system


@pytest.fixture(scope="module")
def rolled_over() -> ns.Solution:
    """Return the run in which the roller comes to lie on the disc."""
    return ns.simulate(_build(), T_END, sample_interval=2e-4)


def test_gaps_and_energy_hold_where_contact_points_run(rolled_over: ns.Solution) -> None:
    """Nothing overlaps, what short bounces gain by mean forces is next to nothing, and what is lost is booked."""
    assert rolled_over.status == "done"
    plate = rolled_over.system.bodies[0]
    for one, other in ((plate, DISC), (plate, ROLLER), (DISC, ROLLER)):
        assert np.min(distances(rolled_over, one, other)["gap"]) > -1e-8
    kinetic, potential = rolled_over.history("kinetic_energy", "potential_energy").values()
    gain = np.max(np.diff(kinetic + potential))
    assert gain < 1e-5 * rolled_over.energy.exchanged
    assert rolled_over.energy.residual < 1e-8


def test_averagings_that_lead_gaps_astray_are_short(rolled_over: ns.Solution) -> None:
    """Several are over before their contact time, and are found again from the state in which they begin."""
    events = rolled_over.events
    begun = np.flatnonzero((events.cause == Cause.AVERAGING) & (events.contact >= 0))
    lasted = events.time[begun + 1] - events.time[begun]
    short = lasted < 0.5 * CONTACT_TIME
    assert np.sum(short) > 5
    for time in (events.time[begun] + 0.5 * lasted)[short][:3]:
        ended = ns.simulate(_build(), float(time))
        found = rolled_over.at(time)["u"]
        np.testing.assert_allclose(found, ended.u_end, rtol=1e-9, atol=1e-7)


def test_a_mean_force_does_not_jump_where_the_slip_turns_back() -> None:
    """Friction forward and backward differ. Within a span the slip may turn from one to the other, and the force not.

    A force that jumped there would have most steps rejected, until their length falls below the time tolerance.
    """
    friction = Directional(forward=0.36, backward=0.77, across=0.38, axis=(-0.84, 1.45, 0.57), body="first")
    solution = ns.simulate(_build(friction), T_END)
    assert Cause.AVERAGING in solution.events.cause
    assert solution.counters.rejected < 2000
    assert solution.energy.residual < 1e-8


def test_energy_is_accounted_where_features_change() -> None:
    """Three rough cylinders rattle on each other: contacts pass ends of features within a span, and their gaps jump.

    The work of a mean force is its power over time.  Force times change of the gap would count such a jump as work.
    """
    law = EnergeticImpact(0.8, exponent=1.5, duration=CONTACT_TIME)
    plate, low, middle, high = (
        Plate(),
        *(CylinderBody(0.006, 0.006, foot_height=0.0, rounding=0.1 * 0.006) for _ in range(3)),
    )
    system = ns.System([plate, low, middle, high])
    for one, other in ((plate, low), (plate, middle), (low, middle), (plate, high), (low, high), (middle, high)):
        system.contact(one, other, normal=Unilateral(), friction=Coulomb(0.5964), impact=law)
    system.place(low, position=(0.0, 0.0, 0.006002950053890234))
    turned = (0.9999999998657876, 0.0, 0.0, 1.6383675789859797e-05)
    system.place(middle, position=(0.0, 0.0, 0.018006049997963795), orientation=turned)
    turned = (0.9999999999999999, 0.0, 0.0, 1.3987437950668378e-08)
    system.place(high, position=(0.0, 5.389359657474002e-08, 0.030007005789228047), orientation=turned)
    solution = ns.simulate(system, 0.003)
    assert Cause.AVERAGING in solution.events.cause
    assert solution.energy.residual < 1e-6
