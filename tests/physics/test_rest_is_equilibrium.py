"""Where bodies have come to rest, forces inside the cones balance the weights: those of the run, and those of scipy."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import nnls

import nonsmooth as ns
from bodies import BoxBody, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from scenarios.dice_throw import DiceThrow
from tests.benchmarks import pile
from tests.histories.closed import closed_contacts

Floats = NDArray[np.float64]
MU = 0.4


def _thrown(seed: int) -> tuple[ns.System, float, float]:
    """Return a bar and a cube thrown onto a floor, and when they have come to rest [s], and mu."""
    rng = np.random.default_rng(seed)
    floor = Plate()
    bodies = [BoxBody(0.03, 0.01, 0.005, rounding=1e-3), BoxBody(0.01, 0.01, 0.01, rounding=1e-3)]
    system = ns.System([floor, *bodies], 9.81)
    for first, second in ((floor, bodies[0]), (floor, bodies[1]), (bodies[0], bodies[1])):
        impact = EnergeticImpact(restitution=0.3)
        system.contact(first, second, normal=Unilateral(), friction=Coulomb(MU), impact=impact)
    for i, body in enumerate(bodies):
        orientation = rng.normal(size=4)
        system.place(
            body,
            position=(0.02 * i, 0.0, 0.05 + 0.06 * i),
            orientation=tuple(orientation / np.linalg.norm(orientation)),
            velocity=tuple(rng.uniform(-0.2, 0.2, 3)),
            angular_velocity=tuple(rng.uniform(-5.0, 5.0, 3)),
        )
    return system, 3.0, MU


def _dice(throw: int) -> tuple[ns.System, float, float]:
    scenario = DiceThrow(throw=throw)
    return scenario.build(), 1.5, scenario.friction


@pytest.mark.parametrize(
    ("system", "t_end", "friction"),
    [pytest.param(*_thrown(seed), id=f"thrown {seed}") for seed in range(4)]
    + [pytest.param(*_dice(throw), id=f"dice {throw}") for throw in (0, 7)],
)
def test_what_rests_is_in_equilibrium(system: ns.System, t_end: float, friction: float) -> None:
    """The wrenches about the mass centres vanish with the forces of the run, and some in cones by scipy do it, too."""
    solution = ns.simulate(system, t_end)
    assert np.max(np.abs(solution.u_end)) < 1e-9
    found = closed_contacts(solution, solution.t_end)
    free = [body for body in system.bodies if body.n_u == 6]
    masses = np.array([body.parameters()["mass"] for body in free])
    centres = np.array([solution.of(body)[0][-1, :3] for body in free])
    weight = 9.81 * np.max(masses)
    arm = 0.01

    def wrench(entry: int, force: Floats) -> Floats:
        made, contact = np.zeros((len(free), 6)), system.contacts[found.contact[entry]]
        for side, body, sign in ((0, contact.first, -1.0), (1, contact.second, 1.0)):
            for i, other in enumerate(free):
                if other is body:
                    made[i] += sign * np.array(
                        [*force, *np.cross(found.contact_point[entry, side] - centres[i], force) / arm]
                    )
        return np.asarray(made.ravel() / weight, float)

    needed = np.zeros((len(free), 6))
    needed[:, 2] = 9.81 * masses / weight
    forces = found.normal_force[:, None] * found.contact_normal + found.friction_force
    borne = sum(wrench(i, force) for i, force in enumerate(forces))
    assert np.max(np.abs(borne - needed.ravel())) < 1e-9
    assert np.min(found.normal_force) >= -1e-9 * weight
    assert np.all(
        np.linalg.norm(found.friction_force, axis=1) <= found.normal_force * (friction + 1e-9) + 1e-9 * weight
    )

    columns = []
    for i, normal in enumerate(found.contact_normal):
        axes = pile.frame(normal)
        for angle in np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False):
            edge = axes[0] + friction * (np.cos(angle) * axes[1] + np.sin(angle) * axes[2])
            columns.append(wrench(i, edge))
    assert nnls(np.array(columns).T, needed.ravel())[1] < 1e-9
