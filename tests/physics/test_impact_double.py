"""Double impacts of a dumbbell: thresholds in mu, stick and slip inside, order of the integrator, units."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from laws import Coulomb, EnergeticImpact


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


@pytest.mark.parametrize("slip", [-0.3, -0.1, 0.0, 0.2])
def test_planar_matrices_will_do(dumbbell_impact: Any, slip: float) -> None:
    """Three freedoms with a vanishing second tangent give what six freedoms give in the plane."""
    mass, normal, tangential = dumbbell_impact(3.9, 0.3)()
    u = _with_rates(normal, tangential, (-0.3, -1.0), slip)
    plane = [0, 2, 4]
    flat = tangential[plane].copy()
    flat[:, :, 1] = 0.0
    laws = [(0.8, 1.0, 1.5, 0.1, 0.2), (0.5, 1.0, 1.5, 0.1, 0.3)]
    full = _solve(mass, normal, tangential, u, laws, 1e-11)
    planar = _solve(mass[np.ix_(plane, plane)], normal[plane], flat, u[plane], laws, 1e-11)
    np.testing.assert_allclose(planar.velocity, full.velocity[plane], rtol=0, atol=1e-9)
    np.testing.assert_allclose(planar.stored, full.stored, rtol=0, atol=1e-9)
