"""Laws that map velocities, where contacts are redundant, masses far apart and bodies wedged."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from laws import MoreauImpact, PoissonImpact
from laws.impact.cone import cone_deviation
from nonsmooth.interfaces import ImpactMap
from nonsmooth.testing.functions import compiled_caller

Array = NDArray[np.float64]


def _balls(random: Any) -> tuple[Array, Array]:
    """Return the Delassus matrix of up to 12 contacts of balls with masses 1 to 1e-4, and rates before."""
    n, bodies = int(random.integers(1, 13)), int(random.integers(1, 4))
    mass, radius = 10.0 ** random.uniform(-4.0, 0.0, bodies), 10.0 ** random.uniform(-2.0, 0.0, bodies)
    columns = np.zeros((bodies, 6, n, 3))
    for a in range(n):
        first, second = random.integers(bodies), random.integers(-1, bodies)
        # axes of a box turn up again and again
        normal = np.round(random.normal(size=3)) if random.random() < 0.5 else random.normal(size=3)
        normal = normal / np.linalg.norm(normal) if normal.any() else np.array([0.0, 0.0, 1.0])
        frame = np.linalg.qr(np.column_stack([normal, np.eye(3)]))[0]
        frame *= np.sign(frame[:, 0] @ normal)
        for body, sign in ((first, 1.0), (second, -1.0)):
            if body >= 0 and (sign > 0.0 or body != first):
                columns[body, :3, a] = sign * frame
                columns[body, 3:, a] = np.cross(-radius[body] * normal, frame, axisb=0, axisc=0)
    inverse = np.concatenate([[1.0 / m] * 3 + [2.5 / (m * r * r)] * 3 for m, r in zip(mass, radius, strict=True)])
    w = columns.reshape(6 * bodies, 3 * n)
    return w.T @ (inverse[:, None] * w), w.T @ random.normal(size=6 * bodies)


def _impulses(delassus: Array, rates: Array, friction: Array, e: float) -> Array:
    n = len(friction)
    call = compiled_caller(
        MoreauImpact(0.5).impulses,
        "map",
        {"friction": friction, "restitution": np.full(n, e), "tangential_restitution": np.full(n, e)},
        "MoreauImpact",
    )
    out = np.zeros(3 * n)
    call(n, np.ascontiguousarray(delassus).ravel(), rates, out)
    return out


def test_inelastic_impacts_always_have_an_answer() -> None:
    """It is finite and solves the problem itself: nothing pulls, friction is in the disc, no energy comes in."""
    for seed in range(60):
        random = np.random.default_rng(seed)
        delassus, rates = _balls(random)
        n = len(rates) // 3
        friction, none, least = random.uniform(0.0, 1.5, n), np.zeros(3 * n), np.zeros(n)
        found = _impulses(delassus, rates, friction, 0.0)
        size = np.max(np.abs(np.append(rates, np.diag(delassus) * found)))
        assert cone_deviation(delassus, rates, none, none, least, found, friction) <= 1e-8 * size, seed
        assert found @ (2.0 * rates + delassus @ found) <= 1e-8 * size * np.max(np.abs(found)), seed


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_a_ball_between_two_walls_does_not_rebound(friction: float) -> None:
    """It approaches one wall and leaves the other, which it touches as well: no velocity rebounds at both."""
    normal = np.array([[1.0, 0, 0], [-1.0, 0, 0]])
    columns = np.zeros((6, 2, 3))
    for a, sign in enumerate((1.0, -1.0)):
        columns[:3, a] = np.column_stack([normal[a], [0, 1, 0], [0, 0, sign]])
        columns[3:, a] = np.cross(-normal[a], columns[:3, a], axisb=0, axisc=0)
    w = columns.reshape(6, 6)
    inverse = np.array([1.0, 1.0, 1.0, 2.5, 2.5, 2.5])
    velocity = np.array([-1.0, 0.2, 0.0, 0.0, 0.0, 0.0])
    delassus = w.T @ (inverse[:, None] * w)
    found = _impulses(delassus, w.T @ velocity, np.full(2, friction), 0.8)
    after = velocity + inverse * (w @ found)
    assert after[0] == pytest.approx(0.0, abs=1e-9)
    assert after @ (after / inverse) < velocity @ (velocity / inverse)


@pytest.mark.parametrize("law", [MoreauImpact(0.9), PoissonImpact(0.973)])
def test_a_ball_wedged_in_a_corner_gets_no_internal_impulses(law: ImpactMap) -> None:
    """With mu > 1 a floor and a wall may press it to each other without bound; the least impulses move it alike."""
    mass, radius = 1e-2, 7e-3
    columns = np.zeros((6, 2, 3))
    for a, normal in enumerate(np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])):
        frame = np.column_stack([normal, [0.0, 1.0, 0.0], np.cross(normal, [0.0, 1.0, 0.0])])
        columns[:3, a] = frame
        columns[3:, a] = np.cross(-radius * normal, frame, axisb=0, axisc=0)
    w = columns.reshape(6, 6)
    inverse = np.array([1.0 / mass] * 3 + [2.5 / (mass * radius**2)] * 3)
    delassus = np.ascontiguousarray(w.T @ (inverse[:, None] * w))
    given = {"friction": np.full(2, 1.04), "restitution": np.full(2, law.restitution)}  # type: ignore[attr-defined]
    if isinstance(law, MoreauImpact):
        given["tangential_restitution"] = np.zeros(2)
    call = compiled_caller(law.impulses, "map", given, type(law).__name__)
    for seed in range(500):
        random = np.random.default_rng(seed)
        velocity = random.normal(size=6) * np.array([1.0, 1.0, 1.0, 100.0, 100.0, 100.0])
        velocity[2 * (seed % 2)] = 0.0
        rates, found = w.T @ velocity, np.zeros(6)
        call(2, delassus.ravel(), rates, found)
        speed = np.max(np.abs(velocity * np.array([1.0, 1.0, 1.0, radius, radius, radius])))
        assert np.max(np.abs(found)) <= 10.0 * mass * speed, seed
        assert found @ (2.0 * rates + delassus @ found) <= 1e-8 * mass * speed**2, seed
