"""Spins along axes in space: of the order of the steps, and unseen by gaps about an axis of revolution."""

from __future__ import annotations

import math

import numpy as np

import nonsmooth as ns
from bodies import Dumbbell, Plate
from laws import Coulomb, NewtonImpact, Unilateral

G, MU = 9.81, 0.2


class _AlongItself(Dumbbell):  # type: ignore[misc]
    """A dumbbell whose spin is integrated along its own axes, whatever it does."""

    @property
    def spin(self) -> int:
        """None."""
        return -1


def _dumbbell(
    spin: float,
    tolerance: float,
    t_end: float,
    height: float = 0.0,
    across: float = 0.3,
    kind: type[Dumbbell] = Dumbbell,
) -> ns.Solution:
    """Return the run of a tilted dumbbell that slides over its lower ball and spins about its rod."""
    plate, body = Plate(), kind()
    system = ns.System([plate, body], G)
    system.contact(plate, body, normal=Unilateral(), friction=Coulomb(MU), impact=NewtonImpact(0.5))
    tilt, half = 0.3, 0.5 * body.centre_distance
    system.place(
        body,
        position=(half * math.cos(tilt), 0.0, height + body.radius + half * math.sin(tilt)),
        orientation=(math.cos(0.5 * tilt), 0.0, -math.sin(0.5 * tilt), 0.0),
        velocity=(0.2, across, 0.0),
        angular_velocity=(spin, 0.0, 0.0),
    )
    return ns.simulate(system, t_end, engine=ns.EventDriven(tolerance=tolerance))


def test_order_of_a_spin() -> None:
    """Fifth order: the error falls with the fifth power of the work, and stays within the tolerance times a bound."""
    truth = _dumbbell(300.0, 1e-13, 0.01)
    assert truth.events.causes() == ["start"]
    tolerances = 10.0 ** -np.arange(5.0, 12.0, 1.0)
    runs = [_dumbbell(300.0, float(tolerance), 0.01) for tolerance in tolerances]
    errors = np.array([np.max(np.abs(run.u_end[3:] - truth.u_end[3:])) for run in runs])
    work = np.array([run.counters.steps + run.counters.rejected for run in runs], dtype=float)
    assert -np.polyfit(np.log(work), np.log(errors), 1)[0] >= 4.8
    assert np.all(errors <= 1e4 * tolerances)


def test_a_spin_about_the_rod_costs_no_evaluations_of_gaps() -> None:
    """The spin moves no surface along its normal: the dumbbell's flights cost about what they cost without it."""
    runs = [_dumbbell(spin, 1e-9, 0.12, height=0.01) for spin in (0.0, 500.0)]
    assert all(len(run.events) > 3 for run in runs)
    still, spinning = (run.counters.gap_looks / len(run.events) for run in runs)
    assert spinning < 2.0 * max(still, 1.0)


def test_a_spin_that_keeps_its_direction_is_integrated_along_the_body() -> None:
    """In a plane the run is that of a body which asks for nothing else, bit for bit; in space it is another one."""

    def ends(across: float) -> tuple[np.ndarray, np.ndarray]:
        own, along = (_dumbbell(0.0, 1e-9, 0.05, across=across, kind=kind).u_end for kind in (Dumbbell, _AlongItself))
        return own, along

    own, along = ends(0.0)
    assert np.array_equal(own, along)
    own, along = ends(0.3)
    assert not np.array_equal(own, along)
    assert np.allclose(own, along, rtol=0.0, atol=1e-6)
