"""Impacts with friction: closed forms, thresholds from both sides, the compliant model, invariance."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import nonsmooth as ns
from laws import Coulomb, EnergeticImpact, Frictionless


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
    e=st.floats(0.0, 1.0),
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


@pytest.mark.parametrize("aspect_ratio", [3.9, 5.7])
@pytest.mark.parametrize("side", [-1e-6, 1e-6])
def test_sliding_impact_presses_the_resting_ball_in(dumbbell_impact: Any, aspect_ratio: float, side: float) -> None:
    """Above mu = 0.4 / (A_r - 1) the far ball's impact, sliding towards the resting ball, loads it: {11,10,11}."""
    mu = 0.4 / (aspect_ratio - 1.0) * (1.0 + side)
    body = dumbbell_impact(aspect_ratio)
    mass, normal, tangential = body(0.0)
    u = _with_rates(normal, tangential, (0.0, -1.0), -50.0)
    laws = [EnergeticImpact(0.6)] * 2, [Coulomb(mu)] * 2
    result = ns.solve_impact(mass, normal, tangential, u, *laws)
    rates = normal.T @ result.velocity
    if side > 0.0:
        assert result.normal_impulse[0] > 0.0
    else:
        assert result.normal_impulse[0] == 0.0
        assert rates[0] > 0.0
    assert np.all(rates >= -1e-12)
    away = ns.solve_impact(mass, normal, tangential, _with_rates(normal, tangential, (0.0, -1.0), 50.0), *laws)
    assert away.normal_impulse[0] == 0.0


def test_a_rod_with_mass_lowers_that_threshold(dumbbell_impact: Any) -> None:
    """With 15 % of the mass in the rod, a friction that left the resting ball alone loads it."""
    impulses = []
    for fraction in (0.0, 0.15):
        mass, normal, tangential = dumbbell_impact(3.9, fraction)(0.0)
        u = _with_rates(normal, tangential, (0.0, -1.0), -50.0)
        result = ns.solve_impact(
            mass, normal, tangential, u, [EnergeticImpact(0.6)] * 2, [Coulomb(0.4 / 2.9 * 0.99)] * 2
        )
        impulses.append(result.normal_impulse[0])
    assert impulses[0] == 0.0
    assert impulses[1] > 0.0


@pytest.mark.parametrize(("aspect_ratio", "printed"), [(3.9, 0.296), (5.7, 0.200)])
@pytest.mark.parametrize("side", [-1e-6, 1e-6])
def test_flat_single_impact_sticks(dumbbell_impact: Any, aspect_ratio: float, printed: float, side: float) -> None:
    """A flat ball B that hits without slip sticks iff mu_s >= a / (a^2 + 1.4), a = A_r - 1."""
    a = aspect_ratio - 1.0
    critical = a / (a * a + 1.4)
    assert critical == pytest.approx(printed, abs=5e-4)
    mass, normal, tangential = dumbbell_impact(aspect_ratio)(0.0)
    mu = critical * (1.0 + side)
    u = _with_rates(normal, tangential, (-0.5, -1.0), 0.0)
    one = normal[:, 1:], tangential[:, 1:]
    for friction in (Coulomb(mu), Coulomb(0.05, mu)):
        result = ns.solve_impact(mass, *one, u, [EnergeticImpact(0.5)], [friction])
        slip = abs(float(tangential[:, 1, 0] @ result.velocity))
        if side > 0.0:
            assert slip <= 1e-12
        else:
            assert slip > 1e-8
            assert abs(result.tangential_impulse[0, 0]) == pytest.approx(
                friction.friction * result.normal_impulse[0], rel=1e-10
            )


def _with_rates(normal: Any, tangential: Any, rates: Any, slip: float) -> Any:
    """Return u with the gap rates and the slip of ball A."""
    return np.linalg.lstsq(np.vstack([normal.T, tangential[:, 0, 0]]), np.array([*rates, slip]), rcond=None)[0]


# aspect ratio, rod mass fraction, shift of the mass centre, gap rates, slip, laws (e, k, eta, mu, mu_s) of A and B
ROUGH = [(0.7, 1.0, 1.5, 0.12, 0.2)] * 2
DOUBLE = {
    "both slide": (3.9, 0.0, 0.0, (-1.0, -0.7), 5.0, [(0.6, 1.0, 1.5, 0.1, 0.1)] * 2),
    "drift: A rests, towards A": (3.9, 0.0, 0.0, (0.0, -1.0), -0.4, [(0.6, 1.0, 1.5, 0.15, 0.15)] * 2),
    "drift: A rests, away from A": (3.9, 0.0, 0.0, (0.0, -1.0), 0.4, [(0.6, 1.0, 1.5, 0.15, 0.15)] * 2),
    "pressed in": (3.9, 0.15, 0.0, (0.0, -1.0), -3.0, [(0.65, 1.0, 1.5, 0.2, 0.2)] * 2),
    "slip reverses": (3.9, 0.15, 0.0, (-0.3, -1.0), -0.1, ROUGH),
    "slip reverses twice": (3.9, 0.15, 0.0, (-0.3, -1.0), -0.2, ROUGH),
    "slip, stick, slip back": (3.9, 0.15, 0.0, (-0.3, -1.0), -0.3, ROUGH),
    "slip, stick, slip on": (3.9, 0.15, 0.0, (-1.0, -0.5), 0.3, ROUGH),
    "slip, stick early, slip on": (3.9, 0.15, 0.0, (-1.0, -0.5), 0.02, ROUGH),
    "frictions differ": (3.9, 0.3, 0.0, (-1.0, -0.2), 0.02, [(0.8, 1.0, 1.5, 0.1, 0.2), (0.5, 1.0, 1.5, 0.1, 0.3)]),
    "mass centre off the middle": (3.9, 0.15, 0.2, (-0.5, -1.0), 0.1, [(0.65, 1.0, 1.5, 0.2, 0.2)] * 2),
    "stiffness differs": (5.7, 0.15, 0.0, (-1.0, -0.9), -0.2, [(0.8, 20.0, 1.5, 0.2, 0.2), (0.6, 1.0, 1.5, 0.2, 0.2)]),
    "both stick at once": (3.9, 0.15, 0.0, (-1.0, -0.6), 0.0, [(0.6, 1.0, 1.5, 0.6, 0.6)] * 2),
    "linear springs": (3.9, 0.15, 0.0, (-0.3, -1.0), -0.2, [(0.7, 1.0, 1.0, 0.2, 0.25)] * 2),
}
TURNING = [
    case for case in DOUBLE if case not in ("both slide", "pressed in", "both stick at once") and "drift" not in case
]


def _double(dumbbell_impact: Any, case: str) -> tuple[Any, Any, Any, Any, Any]:
    aspect, fraction, shift, rates, slip, laws = DOUBLE[case]
    mass, normal, tangential = dumbbell_impact(aspect, fraction)(shift)
    return mass, normal, tangential, _with_rates(normal, tangential, rates, slip), laws


def _solve(mass: Any, normal: Any, tangential: Any, u: Any, laws: Any, tolerance: float) -> ns.ImpactResult:
    impact = [EnergeticImpact(e, stiffness=k, exponent=eta) for e, k, eta, _, _ in laws]
    friction = [Coulomb(mu, static) for *_, mu, static in laws]
    return ns.solve_impact(mass, normal, tangential, u, impact, friction, tolerance=tolerance)


@pytest.mark.parametrize("case", DOUBLE)
def test_double_impact_of_a_dumbbell(dumbbell_impact: Any, compliant: Any, case: str) -> None:
    """Stick, slip and reversal inside a double impact equal the springs integrated in time, to 1e-8."""
    mass, normal, tangential, u, laws = _double(dumbbell_impact, case)
    expected, model = compliant(mass, normal, tangential[:, :, 0], u, laws)
    result = _solve(mass, normal, tangential, u, laws, 1e-12)
    np.testing.assert_allclose(result.velocity, expected, rtol=0, atol=1e-8)
    assert (model.changes > 0) == (case in TURNING)
    lost = 0.5 * (u @ mass @ u - result.velocity @ mass @ result.velocity)
    assert np.sum(result.restitution_loss + result.friction_loss) == pytest.approx(lost, abs=1e-9)
    assert np.all(result.friction_loss >= -1e-12)


CONVERGENT = (
    "both slide",
    "pressed in",
    "slip reverses",
    "slip, stick, slip back",
    "slip, stick, slip on",
    "linear springs",
)


@pytest.mark.parametrize("case", CONVERGENT)
def test_error_follows_the_order(dumbbell_impact: Any, case: str) -> None:
    """Error against tolerance 1e-4..1e-12 by bound, against work by slope (fifth order)."""
    mass, normal, tangential, u, laws = _double(dumbbell_impact, case)
    truth = _solve(mass, normal, tangential, u, laws, 1e-14)
    tolerances = 10.0 ** -np.arange(4.0, 12.5, 1.0)
    results = [_solve(mass, normal, tangential, u, laws, float(tolerance)) for tolerance in tolerances]
    errors = np.array([np.max(np.abs(r.velocity - truth.velocity)) for r in results])
    steps = np.array([r.steps for r in results], dtype=float)
    assert np.all(errors <= 20.0 * tolerances)
    assert errors[0] > errors[-1]
    inside = (errors > 1e-12) & (tolerances <= 1e-5)
    slope = -np.polyfit(np.log(steps[inside]), np.log(errors[inside]), 1)[0]
    assert slope >= 4.0


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
    one = ns.solve_impact(mass, normal, tangential, u, *laws, tolerance=1e-11)
    other = ns.solve_impact(mass, normal, turned, u, *laws, tolerance=1e-11)
    np.testing.assert_allclose(other.velocity, one.velocity, rtol=0, atol=1e-8)
    back = np.stack([turns[i] @ other.tangential_impulse[i] for i in range(2)])
    np.testing.assert_allclose(back, one.tangential_impulse, rtol=0, atol=1e-8)


@pytest.mark.parametrize("speed", [1e-4, 1e3])
@pytest.mark.parametrize("weight", [1e-3, 1e4])
@pytest.mark.parametrize("stiffness", [1e-6, 1e9])
def test_scaling(dumbbell_impact: Any, speed: float, weight: float, stiffness: float) -> None:
    """Units do not matter: the velocity scales with the speed, and neither mass nor stiffness enters."""
    mass, normal, tangential, u, laws = _double(dumbbell_impact, "slip, stick, slip on")
    scaled = [(e, k * stiffness, eta, mu, static) for e, k, eta, mu, static in laws]
    one = _solve(mass, normal, tangential, u, laws, 1e-10)
    other = _solve(weight * mass, normal, tangential, speed * u, scaled, 1e-10)
    np.testing.assert_allclose(other.velocity / speed, one.velocity, rtol=0, atol=1e-9)
    np.testing.assert_allclose(other.normal_impulse / (weight * speed), one.normal_impulse, rtol=0, atol=1e-9)


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
