"""Ellipsoids that roll to and fro without slipping: the energy after more than a hundred oscillations."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import EllipsoidBody, Plate, Rest
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.native.kernel import PLAIN

pytestmark = pytest.mark.skipif(PLAIN, reason="minutes in plain mode")

GRAVITY, SEMI, T_END = 9.81, (0.05, 0.04, 0.03), 45.0
STARTS = {
    "rocking in a plane": ((0.0, 0.4, 0.0), (0.0, 0.0, 0.0)),
    "rolling in space": ((0.3, 0.4, 0.2), (1.0, -0.5, 2.0)),
}
"""Rotation vector [rad] and angular velocity in body axes [rad/s]."""


class Rolled(NamedTuple):
    """What a run did: worst change of the energy over that of the oscillation, oscillations, largest slip [m/s]."""

    change: float
    oscillations: int
    slip: float
    rolled: ns.Solution


def _run(start: str, tolerance: float) -> Rolled:
    """Let an ellipsoid roll from a pose on the plane, at the velocity with which its lowest point rests."""
    body, plate = EllipsoidBody(*SEMI, mass=0.1), Plate(Rest())
    system = ns.System([plate, body], gravity=GRAVITY)
    system.contact(plate, body, normal=Unilateral(), friction=Coulomb(2.0), impact=EnergeticImpact(0.0))
    way, spin = STARTS[start]
    turn, squares = Rotation.from_rotvec(way), np.array(SEMI) ** 2

    def lowest(turns: Rotation) -> np.ndarray:
        down = turns.inv().apply([0.0, 0.0, -1.0])
        return np.asarray(turns.apply(squares * down / np.sqrt(down**2 @ squares)[..., None]))

    point = lowest(turn)
    system.place(
        body,
        position=(0.0, 0.0, -float(point[2])),
        orientation=tuple(np.roll(turn.as_quat(), 1).tolist()),
        velocity=tuple((-np.cross(turn.apply(spin), point)).tolist()),
        angular_velocity=spin,
    )
    engine = ns.EventDriven(tolerance=tolerance)
    solution = ns.simulate(system, T_END, sample_interval=5e-3, engine=engine)
    turns = Rotation.from_quat(np.roll(solution.q[:, 3:7], -1, axis=1))
    mass, moments = body.total_mass, np.array(body.inertia)
    energy = 0.5 * mass * np.sum(solution.u[:, :3] ** 2, axis=1) + 0.5 * solution.u[:, 3:] ** 2 @ moments
    energy += mass * GRAVITY * (solution.q[:, 2] - min(SEMI))
    slip = solution.u[:, :3] + np.cross(turns.apply(solution.u[:, 3:]), lowest(turns))
    tilt = turns.as_matrix()[:, 2, 0]
    return Rolled(
        float(np.max(np.abs(energy - energy[0])) / energy[0]),
        int(np.count_nonzero((tilt[:-1] < 0.0) & (tilt[1:] >= 0.0))),
        float(np.max(np.abs(slip))),
        solution,
    )


@pytest.mark.parametrize("start", STARTS)
def test_energy_stays_over_a_hundred_oscillations(start: str) -> None:
    """To 1e-9 of the energy above that of rest; the contact holds and sticks throughout."""
    found = _run(start, 1e-13)
    assert found.oscillations >= 100
    assert found.change <= 1e-9
    assert found.slip <= 1e-10
    assert len(found.rolled.events.time) == 1
    assert found.rolled.energy.friction_loss == 0.0


def test_what_it_loses_is_the_error_of_the_steps() -> None:
    """It falls with the tolerance, and what the contact's projection takes of the velocities is round-off."""
    found = [_run("rolling in space", tolerance) for tolerance in (1e-9, 1e-11)]
    assert found[0].change <= 2e-6
    assert 30.0 * found[1].change <= found[0].change
    for one in found:
        scale = one.rolled.energy.potential_start - 0.1 * GRAVITY * min(SEMI) + one.rolled.energy.kinetic_start
        assert abs(one.rolled.energy.closing_loss) <= 1e-15 * scale
