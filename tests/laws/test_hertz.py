"""The duration of an elastic impact."""

from __future__ import annotations

import math
from typing import Any

import pytest
from scipy.integrate import solve_ivp

from laws import closing_time, contact_time, effective_modulus
from scenarios.dumbbell import DumbbellScenario

MASS, RADIUS, MODULUS = 3.5e-3, 4.76e-3, 1.15e11


def _integrated(speed: float) -> float:
    """Return how long m x'' = -4/3 E* sqrt(R*) x^(3/2) stays in contact [s]."""
    stiffness = 4.0 / 3.0 * MODULUS * math.sqrt(RADIUS)

    def slope(t: float, y: Any) -> list[float]:
        return [y[1], -stiffness / MASS * max(y[0], 0.0) ** 1.5]

    def apart(t: float, y: Any) -> float:
        return float(y[0])

    apart.terminal, apart.direction = True, -1.0  # type: ignore[attr-defined]
    depth = (1.25 * MASS * speed**2 / stiffness) ** 0.4
    done = solve_ivp(
        slope, (0.0, 1.0), [0.0, speed], events=apart, method="DOP853", rtol=1e-10, atol=[1e-10 * depth, 1e-10 * speed]
    )
    return float(done.t_events[0][0])


@pytest.mark.parametrize("speed", [1e-3, 0.1, 10.0])
def test_contact_time_is_that_of_the_elastic_impact(speed: float) -> None:
    """The published factor 2.87 is 2.868 rounded."""
    assert contact_time(MASS, RADIUS, MODULUS, speed) == pytest.approx(_integrated(speed), rel=1e-3)


@pytest.mark.parametrize("acceleration", [0.1, 9.81, 1e3])
def test_closing_time_belongs_to_the_bounce_that_is_as_short(acceleration: float) -> None:
    """T_c of a bounce with v = a T_c."""
    duration = closing_time(MASS, RADIUS, MODULUS, acceleration)
    assert contact_time(MASS, RADIUS, MODULUS, acceleration * duration) == pytest.approx(duration, rel=1e-12)


def test_the_dumbbell_takes_it_from_its_material() -> None:
    """Steel on steel; softer balls touch longer, and a given time is taken as it is."""
    steel, soft = (DumbbellScenario(young_modulus=e).resolved()["contact_time"] for e in (210e9, 210e7))
    assert steel == pytest.approx(1.303e-4, rel=1e-3)
    assert soft / steel == pytest.approx(100.0 ** (1.0 / 3.0), rel=1e-12)
    assert DumbbellScenario(contact_time=1e-5).resolved()["contact_time"] == 1e-5
    assert effective_modulus((210e9, 0.3), (210e9, 0.3)) == pytest.approx(115.38e9, rel=1e-4)
