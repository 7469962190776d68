"""Impacts beside contacts at rest that only round-off presses: these take no part, and must not delay the end.

Faces at right angles are such contacts. Their gap rates stay within round-off, while the impact moves them along their
tangents.
"""

from __future__ import annotations

import numpy as np
import pytest

from laws import Coulomb, EnergeticImpact
from nonsmooth.problems.impact import solve_impact

E = 0.5
SPEED = 0.01
"""Approach [m/s] of the impact beside the contact at rest; a faster one sets the scale of round-off."""


@pytest.mark.parametrize("direction", [1.0, -1.0])
@pytest.mark.parametrize(
    ("gap_rate", "coupling"),
    [(1e-14, -1e-22), (5e-13, -1e-11), (5e-13, -1e-10), (0.0, -1e-22), (0.0, 1e-22)],
)
def test_a_contact_that_stores_nothing_returns_nothing(gap_rate: float, coupling: float, direction: float) -> None:
    """The gap rate of the third contact stays within round-off, and its slip starts from rest in either direction.

    Without a normal force it has no friction, and without stored energy no expansion.
    """
    normal, tangential = np.eye(3), np.zeros((3, 3, 2))
    normal[1, 2], tangential[1, 2, 0] = coupling, direction
    prescribed = [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [gap_rate, direction * SPEED, 0.0]]
    velocity = np.array([-1.0, -SPEED, 0.0])
    found = solve_impact(
        np.eye(3),
        normal,
        tangential,
        velocity,
        [EnergeticImpact(E)] * 3,
        [Coulomb(0.5)] * 3,
        prescribed=prescribed,
    )
    assert not found.truncated
    np.testing.assert_allclose(found.velocity, -E * velocity, rtol=1e-6, atol=1e-11)
    assert np.all(found.returned <= found.stored + 1e-20)


def test_round_off_in_the_coupling_changes_no_impact() -> None:
    """Contacts at rest share their tangents with the coordinates that are hit; their normals are only nearly apart."""
    for seed in range(60):
        random = np.random.default_rng(seed)
        n = int(random.integers(2, 6))
        n_hit = int(random.integers(1, n))
        normal, tangential = np.eye(n), np.zeros((n, n, 2))
        for contact in range(n):
            along = int(random.integers(n))
            tangential[along, contact, 0] = float(along != contact)
        noise = 10.0 ** random.uniform(-24.0, -16.0, (n, n)) * random.choice([-1.0, 1.0], (n, n))
        velocity = np.where(np.arange(n) < n_hit, -random.uniform(0.5, 1.0, n), 0.0)
        prescribed = np.zeros((n, 3))
        prescribed[:, 1] = -tangential[:, :, 0].T @ velocity
        impact = [EnergeticImpact(random.uniform(0.2, 1.0), stiffness=random.uniform(0.2, 5.0)) for _ in range(n)]
        friction = [Coulomb(random.uniform(0.1, 0.6)) for _ in range(n)]

        def after(normal: np.ndarray) -> np.ndarray:
            problem = np.eye(n), normal, tangential, velocity, impact, friction  # noqa: B023
            return solve_impact(*problem, prescribed=prescribed).velocity  # noqa: B023

        np.testing.assert_allclose(after(normal + noise * (normal == 0.0)), after(normal), atol=1e-7, err_msg=str(seed))
