"""Restitution that depends on the approach speed, against the mechanics that it comes from."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.special import gamma

import nonsmooth as ns
from bodies import Ball, Plate
from laws import (
    Frictionless,
    JohnsonImpact,
    Unilateral,
    ViscoelasticImpact,
    effective_modulus,
    effective_radius,
    hertz_stiffness,
    johnson_restitution,
    johnson_speed,
    viscoelastic_restitution,
    viscoelastic_speed,
)
from nonsmooth.engine.memory.modes import Cause

MASS, RADIUS, MODULUS = 3.5e-3, 4.76e-3, 1.15e11


@pytest.mark.parametrize("speed", [1e-4, 0.01, 0.2, 0.21, 1.0, 30.0])
def test_the_process_leaves_with_e_times_v(speed: float) -> None:
    """The efficiency at the rate of expansion is made such that a lone contact obeys e(v)."""
    for law, e in (
        (JohnsonImpact(0.2), johnson_restitution(speed, 0.2)),
        (ViscoelasticImpact(5.0), viscoelastic_restitution(speed, 5.0)),
    ):
        result = ns.solve_impact([[2.0]], [[1.0]], [[[0.0, 0.0]]], [-speed], [law], [Frictionless()])
        # just above v_1 the efficiency jumps within the last step
        error = 1e-7 if speed == 0.21 else 1e-8
        assert result.velocity[0] / speed == pytest.approx(e, abs=error)
        assert result.returned[0] / result.stored[0] == pytest.approx(e**2, abs=error)
        assert law.is_fulfilled(result.stored[0], result.returned[0], 1e-12)
        assert not law.is_fulfilled(1.0, 1.1, 1e-3)


def test_johnson_is_plastic_loading_and_hertz_unloading() -> None:
    """E^2 is the energy of the elastic recovery over the work of a constant pressure, both by quadrature."""
    pressure = 3e9
    for speed in (10.0, 100.0):
        energy = 0.5 * MASS * speed**2
        # a^2 = 2 R x under the pressure p_d
        depth = math.sqrt(energy / (math.pi * pressure * RADIUS))
        work = quad(lambda x: math.pi * 2.0 * RADIUS * x * pressure, 0.0, depth)[0]
        assert work == pytest.approx(energy)
        a = math.sqrt(2.0 * RADIUS * depth)
        force = math.pi * a**2 * pressure
        # Hertz with the radius of the dent: a^3 = 3 P R' / (4 E*), recovery a^2 / R'
        dent = 4.0 * MODULUS * a**3 / (3.0 * force)
        recovery = a**2 / dent
        back = hertz_stiffness(dent, MODULUS) * quad(lambda x: x**1.5, 0.0, recovery)[0]
        e = johnson_restitution(speed, johnson_speed(MASS, RADIUS, MODULUS, pressure))
        assert e == pytest.approx(math.sqrt(back / energy), rel=1e-8)
    assert johnson_restitution(16.0, 1.0) == pytest.approx(0.5)
    assert johnson_restitution(0.3, 1.0) == 1.0


def _viscoelastic_spheres(beta: float) -> float:
    """Return e of x'' = -x^(3/2) - beta sqrt(x) x', x'(0) = 1, until the force would pull."""

    def slope(t: float, y: np.ndarray) -> list[float]:
        x = max(y[0], 0.0)
        return [y[1], -(x**1.5) - beta * math.sqrt(x) * y[1]]

    def pulls(t: float, y: np.ndarray) -> float:
        return float(y[0] + beta * y[1]) if t > 0.0 else 1.0

    pulls.terminal, pulls.direction = True, -1.0  # type: ignore[attr-defined]
    done = solve_ivp(slope, (0.0, 1e3), [1e-12, 1.0], events=pulls, method="DOP853", rtol=1e-10, atol=1e-14)
    return -float(done.y[1, -1])


@pytest.mark.parametrize(
    ("speed", "error"), [(1e-12, 1e-8), (1e-6, 2e-5), (1e-3, 5e-4), (0.1, 3e-3), (1.0, 5e-3), (100.0, 9e-3)]
)
def test_viscoelastic_is_that_of_the_force(speed: float, error: float) -> None:
    """The approximant is within 0.005 of the integrated force up to v_1, within 0.009 at 100 times that.

    In units of Hertz, x by (m / k)^(2/5) v^(4/5) and t by that over v, the damping is beta v^(1/5).
    """
    assert viscoelastic_restitution(speed, 1.0) == pytest.approx(_viscoelastic_spheres(speed**0.2), abs=error)


def test_viscoelastic_starts_as_the_series() -> None:
    """E = 1 - C_1 (v / v_1)^(1/5) + 3/5 C_1^2 (v / v_1)^(2/5) for slow impacts."""
    # the constant in closed form, 1.15344
    c1 = gamma(0.6) * math.sqrt(math.pi) / (2.0**0.4 * gamma(2.1)) * 5.0**-0.4 * 2.0**0.2
    assert c1 == pytest.approx(1.15344, abs=1e-5)
    for speed in (1e-15, 1e-12):
        s = speed**0.2
        series = 1.0 - c1 * s + 0.6 * c1**2 * s**2
        # the approximant prints C_1 with six digits
        assert viscoelastic_restitution(speed, 1.0) == pytest.approx(series, abs=1e-5 * s + 2.0 * s**2.5)


def test_viscoelastic_speed_scales_as_the_force() -> None:
    """In SI units: the same e from the force k (x^(3/2) + 3/2 A sqrt(x) x') itself."""
    dissipation, speed = 2e-6, 0.5
    stiffness = hertz_stiffness(RADIUS, MODULUS)
    beta = 1.5 * dissipation * (stiffness / MASS) ** 0.4 * speed**0.2
    reference = viscoelastic_speed(MASS, RADIUS, MODULUS, dissipation)
    assert viscoelastic_restitution(speed, reference) == pytest.approx(_viscoelastic_spheres(beta), abs=5e-3)


def test_a_falling_ball_bounces_ever_more_elastically() -> None:
    """In a run: every bounce has the e of its own speed, so that it rises from bounce to bounce."""
    plate, ball, law = Plate(), Ball(0.01), ViscoelasticImpact(10.0)
    system = ns.System([plate, ball])
    system.contact(plate, ball, normal=Unilateral(), friction=Frictionless(), impact=law)
    system.place(ball, position=(0.0, 0.0, 0.06))
    events = ns.simulate(system, 0.8).events
    hits = events.cause == Cause.IMPACT
    before, after = -events.u_before[hits][:, 2], events.u_after[hits][:, 2]
    assert len(before) >= 3
    np.testing.assert_allclose(after / before, [viscoelastic_restitution(v, 10.0) for v in before], rtol=0, atol=1e-6)
    assert np.all(np.diff(after / before) > 0.0)


def test_hertz_from_materials_and_radii() -> None:
    """Equal spheres, a plane, a rigid partner, the ratio of two contacts, and the static indentation."""
    steel, rubber = (210e9, 0.3), (5e6, 0.5)
    assert effective_modulus(steel, steel) == pytest.approx(210e9 / (2.0 * (1.0 - 0.3**2)))
    assert effective_modulus(rubber, (math.inf, 0.3)) == pytest.approx(5e6 / 0.75)
    assert effective_radius(0.02, 0.02) == pytest.approx(0.01)
    assert effective_radius(0.02) == 0.02
    one = hertz_stiffness(effective_radius(0.02, 0.02), effective_modulus(steel, steel))
    other = hertz_stiffness(effective_radius(0.02), effective_modulus(steel, (math.inf, 0.0)))
    # twice the radius, twice the modulus
    assert other / one == pytest.approx(2.0 * math.sqrt(2.0))
    # x = (9 P^2 / (16 R E^2))^(1/3), Johnson (4.23)
    load, radius, modulus = 50.0, 0.01, effective_modulus(steel, steel)
    indentation = (9.0 * load**2 / (16.0 * radius * modulus**2)) ** (1.0 / 3.0)
    assert hertz_stiffness(radius, modulus) * indentation**1.5 == pytest.approx(load, rel=1e-12)
