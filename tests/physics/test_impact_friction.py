"""Impacts with friction: closed forms, thresholds from both sides, the compliant model, invariance."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import nonsmooth as ns
from bodies import BoxBody, Compound, Part
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral


def _sphere(mass: float = 0.3, radius: float = 0.02) -> tuple[Any, Any, Any]:
    """M, W, N of a sphere over a plane, u = (velocity, angular velocity)."""
    moment = 0.4 * mass * radius**2
    normal = np.array([[0.0, 0.0, 1.0, 0.0, 0.0, 0.0]]).T
    tangential = np.array([[1.0, 0, 0, 0, -radius, 0], [0, 1.0, 0, radius, 0, 0]]).T[:, None, :]
    return np.diag([mass] * 3 + [moment] * 3), normal, tangential


def _rigid(seed: int, n: int) -> tuple[Any, Any, Any]:
    """M, W, N of a body of arbitrary shape with n contacts in arbitrary directions."""
    random = np.random.default_rng(seed)
    mass = np.diag([1.0] * 3 + list(random.uniform(0.2, 0.6, 3)))
    normal, tangential = np.zeros((6, n)), np.zeros((6, n, 2))
    for i in range(n):
        axes = np.linalg.qr(random.normal(size=(3, 3)) + 3.0 * np.eye(3)[[2, 0, 1]].T)[0]
        axes[:, 0] *= np.sign(axes[2, 0])
        arm = random.uniform(-1.0, 1.0, 3)
        columns = np.vstack([axes, np.cross(arm, axes.T).T])
        normal[:, i], tangential[:, i] = columns[:, 0], columns[:, 1:]
    return mass, normal, tangential


slopes = st.floats(0.01, 20.0)


@settings(max_examples=80)
@given(
    mu=st.floats(0.01, 1.5),
    # a restitution of 1e-8 counts as none
    e=st.just(0.0) | st.floats(1e-7, 1.0),
    ratio=slopes,
    heading=st.floats(0.0, 2 * math.pi),
    vn=st.floats(0.01, 9.0),
)
def test_oblique_sphere(mu: float, e: float, ratio: float, heading: float, vn: float) -> None:
    """Sticks at the end iff |v_t| <= 3.5 mu (1 + e) |v_n|, else keeps the rest; to 1e-10."""
    mass, normal, tangential = _sphere()
    before = ratio * vn
    u = np.array([before * math.cos(heading), before * math.sin(heading), -vn, 0.0, 0.0, 0.0])
    result = ns.solve_impact(mass, normal, tangential, u, [EnergeticImpact(e)], [Coulomb(mu)])
    slip = tangential[:, 0].T @ result.velocity
    after = max(0.0, before - 3.5 * mu * (1.0 + e) * vn)
    expected = after * np.array([math.cos(heading), math.sin(heading)])
    np.testing.assert_allclose(slip, expected, rtol=0, atol=1e-10 * max(vn, before))
    assert result.velocity[2] == pytest.approx(e * vn, abs=1e-10 * vn)


@pytest.mark.parametrize("side", [-1e-6, 1e-6])
@pytest.mark.parametrize("e", [0.0, 0.6, 1.0])
def test_oblique_sphere_at_its_threshold(side: float, e: float) -> None:
    """Both sides of 3.5 mu (1 + e) |v_n|: slip left over above it, rolling below."""
    mass, normal, tangential = _sphere()
    mu = 0.2
    speed = 3.5 * mu * (1.0 + e) * (1.0 + side)
    u = np.array([speed, 0.0, -1.0, 0.0, 0.0, 0.0])
    result = ns.solve_impact(mass, normal, tangential, u, [EnergeticImpact(e)], [Coulomb(mu)])
    slip = float(tangential[:, 0, 0] @ result.velocity)
    assert slip == pytest.approx(max(0.0, side) * 3.5 * mu * (1.0 + e), abs=1e-11)
    friction = float(np.hypot(*result.tangential_impulse[0]))
    assert friction <= mu * result.normal_impulse[0] * (1.0 + 1e-12)


def _turning_slip(mass: Any, normal: Any, tangential: Any, u: Any, laws: Any) -> Any:
    """Integrate sliding springs in 3D with scipy; no contact sticks or is compressed twice."""
    from scipy.integrate import solve_ivp

    inverse, n = np.linalg.inv(mass), len(laws)
    phase = [1 if r < 0.0 else 0 for r in normal.T @ u]

    def slope(t: float, y: Any) -> Any:
        dy = np.zeros_like(y)
        for i, (e, k, eta, mu) in enumerate(laws):
            if phase[i] == 0:
                continue
            force = k * max(y[6 + i], 0.0) ** eta
            v = tangential[:, i].T @ y[:6]
            push = normal[:, i] * force - tangential[:, i] @ (mu * force * v / np.hypot(*v))
            dy[:6] += inverse @ push
            dy[6 + i] = -(normal[:, i] @ y[:6]) / (1.0 if phase[i] == 1 else e * e)
        return dy

    def guard(i: int) -> Any:
        def value(t: float, y: Any) -> float:
            if phase[i] == 0:
                return 1.0
            return float(-normal[:, i] @ y[:6] if phase[i] == 1 else y[6 + i])

        value.terminal, value.direction = True, -1.0  # type: ignore[attr-defined]
        return value

    y, t = np.concatenate([u, np.zeros(n)]), 0.0
    while any(phase):
        found = solve_ivp(
            slope,
            (t, t + 100.0),
            y,
            "DOP853",
            events=[guard(i) for i in range(n)],
            rtol=1e-13,
            atol=1e-15,
            max_step=0.05,
        )
        t, y = found.t[-1], found.y[:, -1]
        for i in range(n):
            if len(found.t_events[i]):
                phase[i] = (phase[i] + 1) % 3
                assert phase[i] != 0 or normal[:, i] @ y[:6] > 0.0
    return y[:6]


@pytest.mark.parametrize(("seed", "n"), [(1, 1), (2, 1), (3, 2), (4, 2)])
def test_turning_slip_in_3d(seed: int, n: int) -> None:
    """Skew slip whose direction turns during the impact equals an independent integration, to 1e-8."""
    mass, normal, tangential = _rigid(seed, n)
    random = np.random.default_rng(seed + 100)
    u = np.concatenate([[2.0, -1.5, -1.0], random.uniform(-0.4, 0.4, 3)])
    laws = [(0.7, 1.0, 1.5, 0.2), (0.5, 3.0, 1.5, 0.1)][:n]
    expected = _turning_slip(mass, normal, tangential, u, laws)
    result = ns.solve_impact(
        mass, normal, tangential, u,
        [EnergeticImpact(e, stiffness=k, exponent=eta) for e, k, eta, _ in laws],
        [Coulomb(mu) for *_, mu in laws],
        tolerance=1e-12,
    )  # fmt: skip
    np.testing.assert_allclose(result.velocity, expected, rtol=0, atol=1e-8)
    before, after = (tangential[:, 0].T @ x for x in (u, result.velocity))
    turned = abs(before[0] * after[1] - before[1] * after[0]) / (np.hypot(*before) * np.hypot(*after))
    assert turned > 1e-3


velocities = st.lists(st.floats(-2.0, 2.0), min_size=6, max_size=6)
restitutions = st.floats(0.0, 1.0)
frictions = st.floats(0.0, 0.8)


@settings(max_examples=60)
@given(
    seed=st.integers(0, 10**6),
    u=velocities,
    e=st.tuples(restitutions, restitutions),
    mu=st.tuples(frictions, frictions),
    k=st.floats(0.1, 10.0),
)
def test_energy_account_closes(seed: int, u: Any, e: Any, mu: Any, k: float) -> None:
    """Skew slip with spin at two contacts: the account explains the kinetic energy to 1e-9, impulses the velocity."""
    mass, normal, tangential = _rigid(seed, 2)
    velocity = np.array(u)
    impact = [EnergeticImpact(e[0]), EnergeticImpact(e[1], stiffness=k)]
    result = ns.solve_impact(
        mass, normal, tangential, velocity, impact, [Coulomb(m) if m > 0.02 else Frictionless() for m in mu]
    )
    lost = 0.5 * (velocity @ mass @ velocity - result.velocity @ mass @ result.velocity)
    booked = np.sum(result.restitution_loss + result.friction_loss)
    assert booked == pytest.approx(lost, abs=1e-9 * max(1.0, float(velocity @ velocity)))
    push = normal @ result.normal_impulse + np.einsum("uni,ni->u", tangential, result.tangential_impulse)
    np.testing.assert_allclose(mass @ (result.velocity - velocity), push, rtol=0, atol=1e-11)
    assert np.all(normal.T @ result.velocity >= -1e-9)
    assert np.all(result.friction_loss >= -1e-10)
    for law, stored, returned in zip(impact, result.stored, result.returned, strict=True):
        assert law.is_fulfilled(stored, returned, 1e-8)


@settings(max_examples=25)
@given(seed=st.integers(0, 10**6), angles=st.tuples(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0)))
def test_tangents_are_arbitrary(seed: int, angles: Any) -> None:
    """Rotating the tangents of every contact changes no velocity and turns the impulses."""
    mass, normal, tangential = _rigid(seed, 2)
    u = np.array([1.0, -0.5, -1.0, 0.3, 0.2, -0.4])
    laws = [EnergeticImpact(0.7), EnergeticImpact(0.4)], [Coulomb(0.3), Coulomb(0.15, 0.4)]
    turns = [np.array([[math.cos(a), -math.sin(a)], [math.sin(a), math.cos(a)]]) for a in angles]
    turned = np.stack([tangential[:, i] @ turns[i] for i in range(2)], axis=1)
    # a slip that circles next to rest ends within a multiple of the tolerance
    one = ns.solve_impact(mass, normal, tangential, u, *laws, tolerance=1e-12)
    other = ns.solve_impact(mass, normal, turned, u, *laws, tolerance=1e-12)
    np.testing.assert_allclose(other.velocity, one.velocity, rtol=0, atol=1e-8)
    back = np.stack([turns[i] @ other.tangential_impulse[i] for i in range(2)])
    np.testing.assert_allclose(back, one.tangential_impulse, rtol=0, atol=1e-8)


def test_without_approach_nothing_happens() -> None:
    """A separating and a grazing contact leave the velocity alone."""
    mass, normal, tangential = _sphere()
    for rate in (0.0, 0.3):
        u = np.array([1.0, 0.5, rate, 0.0, 0.0, 2.0])
        result = ns.solve_impact(mass, normal, tangential, u, [EnergeticImpact(0.5)], [Coulomb(0.3)])
        np.testing.assert_array_equal(result.velocity, u)
        assert result.phases == 0


def test_driven_side_counts() -> None:
    """A plate that comes up at the ball is as good as a ball that comes down."""
    mass, normal, tangential = _sphere()
    laws = [EnergeticImpact(0.6)], [Coulomb(0.2)]
    falling = ns.solve_impact(mass, normal, tangential, (0.5, 0.2, -1.0, 0, 0, 0), *laws)
    rising = ns.solve_impact(mass, normal, tangential, np.zeros(6), *laws, prescribed=[(-1.0, 0.5, 0.2)])
    np.testing.assert_allclose(rising.velocity, falling.velocity - (0.5, 0.2, -1.0, 0, 0, 0), rtol=0, atol=1e-12)


@pytest.mark.parametrize("contacts", [1, 2])
def test_friction_to_zero_is_frictionless(contacts: int) -> None:
    """The limit mu -> 0 is the frictionless impact, linearly in mu."""
    mass, normal, tangential = _rigid(5, contacts)
    u = np.array([1.0, -0.5, -1.0, 0.3, 0.2, -0.4])
    impact = [EnergeticImpact(0.7)] * contacts
    smooth = ns.solve_impact(mass, normal, tangential, u, impact, [Frictionless()] * contacts, tolerance=1e-12)
    with pytest.warns(UserWarning, match="usual range"):
        friction = [[Coulomb(mu)] * contacts for mu in (1e-4, 1e-6)]
    gaps = [
        np.max(
            np.abs(ns.solve_impact(mass, normal, tangential, u, impact, f, tolerance=1e-12).velocity - smooth.velocity)
        )
        for f in friction
    ]
    assert gaps[0] <= 1e-3
    assert gaps[1] / gaps[0] == pytest.approx(1e-2, rel=0.05)


@pytest.mark.parametrize("mu", [0.045, 0.048, 0.05, 0.053])
def test_two_contacts_that_share_their_friction(mu: float) -> None:
    """A body falls straight: who bears the friction is not unique, and at the bound it ends all the same."""
    mass, normal, tangential = np.diag([1.0, 1.0, 1.0, 0.3, 0.4, 0.5]), np.zeros((6, 2)), np.zeros((6, 2, 2))
    for i in range(2):
        arm = np.array([i - 0.5, 0.1 * i, -0.5])
        for column, axis in ((normal[:, i], 2), (tangential[:, i, 0], 0), (tangential[:, i, 1], 1)):
            column[axis], column[3:] = 1.0, np.cross(arm, np.eye(3)[axis])
    u = np.array([0.0, 0.0, -1.0, 0.0, 0.0, 0.0])
    result = ns.solve_impact(mass, normal, tangential, u, [EnergeticImpact(0.65)] * 2, [Coulomb(mu)] * 2)
    assert result.phases < 200
    np.testing.assert_allclose(result.returned, 0.65**2 * result.stored, rtol=1e-8)
    assert np.all(np.linalg.norm(result.tangential_impulse, axis=1) <= mu * result.normal_impulse * (1.0 + 1e-9))
    assert np.all(normal.T @ result.velocity >= -1e-12)
    lost = 0.5 * u @ mass @ u - 0.5 * result.velocity @ mass @ result.velocity
    assert lost == pytest.approx(np.sum(result.stored - result.returned + result.friction_loss), rel=1e-9)


@pytest.mark.parametrize("e", [0.05, 0.102, 0.2])
def test_a_tetrahedron_on_three_corners_rattles_to_the_end(e: float) -> None:
    """Slips start from rest and stop again while next to nothing of the motion is left: each is passed once."""
    columns = np.array(
        [
            [-550.0, 13.0, -11.0, -961.0, 19.0, -20.0, -634.0, 17.0, -12.0],
            [7.0, 182.0, -528.0, 24.0, 372.0, -869.0, 29.0, 318.0, -571.0],
            [-10.0, -690.0, -306.0, -10.0, -690.0, -306.0, -10.0, -690.0, -306.0],
            [2112.0, -41.0, 45.0, -2044.0, 12.0, -51.0, 1265.0, -3.0, 33.0],
            [-152.0, -1313.0, 1737.0, 30.0, 678.0, -1844.0, 85.0, 111.0, 1290.0],
            [-2073.0, 61.0, -72.0, -535.0, -46.0, 120.0, 2608.0, -15.0, -48.0],
        ]
    )
    u = np.array([5.895e-06, 2.514e-07, 1.612e-07, -3.647e-06, -3.333e-08, 1.083e-06])
    normal, tangential = columns[:, ::3], np.stack([columns[:, 1::3], columns[:, 2::3]], axis=2)
    laws, friction = [EnergeticImpact(e)] * 3, [Coulomb(0.191)] * 3
    result = ns.solve_impact(np.eye(6), normal, tangential, u, laws, friction, tolerance=1e-8)
    assert result.phases < 1000
    assert np.min(normal.T @ result.velocity) > -1e-8 * np.max(np.abs(normal.T @ u))
    lost = np.sum(result.restitution_loss) + np.sum(result.friction_loss)
    assert result.velocity @ result.velocity + 2.0 * lost == pytest.approx(u @ u, rel=1e-7)


@pytest.mark.parametrize("friction", [0.3, 0.9])
@pytest.mark.parametrize("n_parts", [1, 2, 3])
@pytest.mark.parametrize("across", [(0.0, 0.0), (0.2, 0.0), (0.3, 0.4)])
def test_flush_bodies_that_stick_move_as_one(friction: float, n_parts: int, across: tuple[float, float]) -> None:
    """After a plastic impact with enough friction, however many contacts share it, nothing slips."""
    box = BoxBody(half_x=0.006, half_y=0.006, half_z=0.006)
    one, two = (
        Compound(parts=tuple(Part(box, position=(0.012 * i, 0.0, 0.0)) for i in range(n_parts))) for _ in range(2)
    )
    system = ns.System([one, two], gravity=0.0)
    system.contact(one, two, normal=Unilateral(), friction=Coulomb(friction), impact=EnergeticImpact(0.0))
    system.place(one, velocity=(0.0, -2.0, 0.0))
    system.place(two, position=(0.001, -0.0121, 0.002), velocity=(across[0], 2.0, across[1]))
    events = ns.simulate(system, 4e-5).events
    ours, theirs = events.u_after[-1].reshape(2, 6)
    between = np.subtract(*events.q[-1].reshape(2, 7)[::-1, :3])
    # the bodies have not turned before the impact, so their axes are those of the world
    np.testing.assert_allclose(theirs[3:], ours[3:], rtol=0, atol=1e-9)
    np.testing.assert_allclose(theirs[:3], ours[:3] + np.cross(ours[3:], between), rtol=0, atol=1e-11)
