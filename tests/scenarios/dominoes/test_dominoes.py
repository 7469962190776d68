"""Dominoes: the first strike, the row one after the other, what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from scenarios.dominoes import Dominoes


@pytest.mark.slow
@pytest.mark.parametrize(("spacing", "lean"), [(0.014, 0.03), (0.02, 0.05)])
def test_the_first_strike_is_that_of_a_fall_about_the_edge(spacing: float, lean: float) -> None:
    """And the wave then runs faster and faster, from each to the next."""
    row = Dominoes(number=5, spacing=spacing, lean=lean, t_end=0.38)
    solution = ns.simulate(row.build(), row.t_end)
    strikes = row.strikes(solution)
    assert strikes[0] == pytest.approx(row.first_strike(), abs=1e-9)
    assert len(strikes) >= 3
    assert np.all(np.diff(row.speeds(solution)) > 0.0)
    account = solution.energy
    start, end = account.kinetic_start + account.potential_start, account.kinetic_end + account.potential_end
    assert start - end == pytest.approx(account.loss, rel=1e-4)


@pytest.mark.slow
def test_no_two_dominoes_overlap() -> None:
    """The upper edge of each stays on this side of the next one's face."""
    row = Dominoes(number=4, t_end=0.36)
    solution = ns.simulate(row.build(), row.t_end, sample_interval=row.sample_interval)
    q = solution.q.reshape(len(solution.t), -1, 3)
    for i in range(3):
        c, s = np.cos(q[:, i, 2]), np.sin(q[:, i, 2])
        half = 0.5 * row.thickness, 0.5 * row.height
        corner = q[:, i, :2] + np.column_stack([half[0] * c + half[1] * s, -half[0] * s + half[1] * c])
        apart = corner - q[:, i + 1, :2]
        c, s = np.cos(q[:, i + 1, 2]), np.sin(q[:, i + 1, 2])
        along = apart[:, 0] * c - apart[:, 1] * s
        above = apart[:, 0] * s + apart[:, 1] * c
        beside = np.abs(above) < half[1]
        assert np.max(along[beside]) <= -half[0] + 1e-8


@pytest.mark.slow
def test_the_account_of_the_impacts_closes() -> None:
    """In those of many contacts some stay at rest under load while others act: what they give back counts, too."""
    # every one strikes the next, whatever else collides
    row = Dominoes(number=17, t_end=0.7)
    solution = ns.simulate(row.build(), row.t_end, sample_interval=row.sample_interval)
    assert solution.status == "done"
    assert solution.counters.impacts > 20
    assert solution.energy.residual < 1e-8


def test_parts_of_dominoes_are_refused() -> None:
    with pytest.raises(ns.InvalidInput, match=r"Dominoes\.number must be an integer"):
        Dominoes(**dict[str, Any](number=2.5))


def test_too_wide_a_distance_is_refused() -> None:
    with pytest.raises(ns.InvalidInput, match=r"Dominoes\.spacing"):
        Dominoes(spacing=0.05)
