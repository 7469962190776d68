"""Bodies that fly: closed forms of tops, in steps of any length, beside bodies that are integrated."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Ball, BallJoint, BoxBody, CylinderBody, DiscBody, Dumbbell, FreeBody, Harmonic, Plate
from bodies.inertia import tensor_of
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.native.kernel import PLAIN
from tests.engine.tops import Top

GRAVITY = 9.0
LAWS: dict[str, Any] = {"normal": Unilateral(), "friction": Coulomb(0.3), "impact": EnergeticImpact(0.7)}
TURNED = (math.cos(0.4), 0.6 * math.sin(0.4), 0.0, 0.8 * math.sin(0.4))


def _matrix(quaternion: Any) -> Any:
    return Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()


def _expected(body: FreeBody, spin: Any, t: float) -> tuple[Any, Any]:
    """Return axes and angular velocity in space of a symmetric top, by rotations about L and its own axis."""
    tensor, start = tensor_of(body.inertia, body.products), _matrix(TURNED)
    moments = np.diag(tensor)
    axis = next(i for i in range(3) if moments[(i + 1) % 3] == moments[(i + 2) % 3])
    across, e = moments[(axis + 1) % 3], np.eye(3)[axis]
    turning = start @ tensor @ np.array(spin) / across
    own = (1.0 - moments[axis] / across) * spin[axis] * e
    axes = Rotation.from_rotvec(t * turning).as_matrix() @ start @ Rotation.from_rotvec(t * own).as_matrix()
    return axes, turning + axes @ own


@settings(max_examples=25, deadline=None)
@given(
    body=st.sampled_from(
        [Ball(0.02), Dumbbell(), CylinderBody(0.02, 0.03), DiscBody(0.05), Top(), BoxBody(0.1, 0.1, 0.1)]
    ),
    spin=st.tuples(*[st.floats(-200.0, 200.0)] * 3),
)
def test_a_symmetric_top_flies_in_one_step(body: FreeBody, spin: Any) -> None:
    """Two hundred radians a second for a second: precession about the angular momentum and a fall, to round-off."""
    system = ns.System([body], GRAVITY)
    system.place(body, orientation=TURNED, velocity=(1.0, 2.0, 3.0), angular_velocity=spin)
    solution = ns.simulate(system, 1.0, engine=ns.EventDriven(largest_step=10.0), sample_interval=0.25)
    # a closed form; an integration takes hundreds of steps
    assert solution.counters.steps < 10
    for t, q, u in zip(solution.t, solution.q, solution.u, strict=True):
        g = np.array([0.0, 0.0, -GRAVITY])
        np.testing.assert_allclose(q[:3], t * np.array([1.0, 2.0, 3.0]) + 0.5 * t * t * g, rtol=0, atol=1e-13)
        np.testing.assert_allclose(u[:3], np.array([1.0, 2.0, 3.0]) + t * g, rtol=0, atol=1e-13)
        axes, turning = _expected(body, spin, t)
        np.testing.assert_allclose(_matrix(q[3:]), axes, rtol=0, atol=1e-11)
        np.testing.assert_allclose(axes @ u[3:], turning, rtol=0, atol=1e-9)
    assert abs(np.linalg.norm(solution.q_end[3:]) - 1.0) < 1e-15
    assert solution.energy.residual < 1e-12


@pytest.mark.parametrize("body", [Ball(0.02), BoxBody(0.02, 0.03, 0.04)], ids=["closed form", "integrated"])
def test_a_fall_exchanges_its_potential_energy(body: FreeBody) -> None:
    """Gravity gives m g h, of which nothing is lost."""
    solution = ns.simulate(ns.System([body], GRAVITY), 0.3)
    assert solution.energy.exchanged == pytest.approx(body.total_mass * 0.5 * (GRAVITY * 0.3) ** 2, rel=1e-9)


def test_the_closed_form_is_what_integration_tends_to() -> None:
    """A top next to symmetric, which is integrated, tends to the symmetric one as the difference does."""
    ends = []
    for moment in (0.02, 0.02 * (1.0 + 1e-7)):
        body = Top((0.02, 0.013, moment))
        assert (body.flight is None) == (moment != 0.02)
        system = ns.System([body], GRAVITY)
        system.place(body, angular_velocity=(3.0, 7.0, -4.0))
        solution = ns.simulate(system, 1.0, engine=ns.EventDriven(tolerance=1e-12))
        ends.append(np.append(solution.q_end, solution.u_end))
    assert 0.0 < np.max(np.abs(ends[1] - ends[0])) < 1e-5


def test_what_is_held_is_integrated() -> None:
    """A ball on a joint swings as a pendulum does, though balls know how they fly."""
    ball, base = Ball(0.01), Plate()
    system = ns.System([base, ball], 9.81)
    system.joint(BallJoint((0.0, 0.0, 1.0), (-0.2, 0.0, 0.0)), base, ball)
    system.place(ball, position=(0.2, 0.0, 1.0))
    solution = ns.simulate(system, 0.3)
    arm = solution.q_end[:3] - [0.0, 0.0, 1.0]
    assert np.linalg.norm(arm) == pytest.approx(0.2, abs=1e-9)
    assert solution.energy.residual < 1e-7


@pytest.mark.parametrize("spin", [0.0, 150.0])
def test_one_that_flies_changes_nothing_of_one_that_slides(spin: float) -> None:
    """A ball that slides on a plate, alone and with three others that bounce: neither knows of the other."""
    t_end = 0.05 if PLAIN else 0.3
    ends = []
    for some in ((0,), (1, 2, 3), (0, 1, 2, 3)):
        plate, balls = Plate(Harmonic(3e-4, 20.0)), [Ball(0.01) for _ in some]
        system = ns.System([plate, *balls], 9.81)
        for ball, i in zip(balls, some, strict=True):
            system.contact(plate, ball, **LAWS)
            ns.at_height(system, ball, 0.004 * i, velocity=(0.3, 0.02 * i, 0.0), angular_velocity=(spin, 1.0 * i, -5.0))
            x, y, z = system.start(ball)[0][:3]
            system.place(
                ball,
                position=(x + 0.1 * i, y, z),
                velocity=(0.3, 0.02 * i, 0.0),
                angular_velocity=(spin, 1.0 * i, -5.0),
            )
        solution = ns.simulate(system, t_end, sample_interval=t_end / 7.0)
        assert solution.energy.residual < 1e-8
        ends.append((solution.q, solution.u))
    (slid_q, slid_u), (flown_q, flown_u), (q, u) = ends
    np.testing.assert_allclose(q, np.hstack([slid_q, flown_q]), rtol=0, atol=3e-8)
    np.testing.assert_allclose(u, np.hstack([slid_u, flown_u]), rtol=1e-6, atol=3e-6)


@pytest.mark.parametrize("across", [0.0, 1.0])
def test_a_bouncing_dumbbell_converges(across: float) -> None:
    """With tolerance, the same motion on a plate: fast rolling, flight, impacts, slip."""
    t_end = 0.02 if PLAIN else 0.08
    ends = []
    for tolerance in (1e-7, 1e-9, 1e-11):
        plate, body = Plate(Harmonic(3e-4, 25.0)), Dumbbell()
        system = ns.System([plate, body], 9.81)
        system.contact(plate, body, **LAWS)
        ns.at_height(system, body, 1e-3, velocity=(0.0, across, 0.0), angular_velocity=(-150.0 * across, 1.0, 0.0))
        engine = ns.EventDriven(tolerance=tolerance, impact_tolerance=1e-11)
        solution = ns.simulate(system, t_end, engine=engine, sample_interval=t_end)
        assert solution.energy.residual < 1e3 * tolerance
        ends.append(np.append(solution.q_end, solution.u_end))
    coarse, fine = (float(np.max(np.abs(end - ends[2]))) for end in ends[:2])
    assert fine < 1e-5
    assert fine < 0.2 * coarse or coarse < 1e-8


def test_a_gap_that_a_spinning_body_closes_is_not_missed() -> None:
    """A long dumbbell that turns fast over a plate meets it within a turn, in steps that no error keeps short."""
    body, plate = Dumbbell(radius=0.005, aspect_ratio=8.0), Plate()
    half = body.centre_distance / 2.0
    system = ns.System([plate, body], 0.0)
    system.contact(plate, body, **LAWS)
    height = half + body.radius - 2e-4
    rate = 120.0
    system.place(body, position=(0.0, 0.0, height), angular_velocity=(0.0, rate, 0.0))
    solution = ns.simulate(system, 0.1, engine=ns.EventDriven(largest_step=10.0))
    # the ball ahead is down to the plate when the rod has turned to this angle
    expected = math.asin((height - body.radius) / half) / rate
    assert solution.counters.impacts >= 1
    assert solution.events.time[1] == pytest.approx(expected, abs=1e-9)
