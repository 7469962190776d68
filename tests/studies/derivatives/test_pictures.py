"""Pictures of derivatives and fits show what they are of."""

from __future__ import annotations

import math

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plate
from laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.studies import Family, fit, sensitivity
from nonsmooth.studies.derivatives import pictures

pytest.importorskip("matplotlib")
pytestmark = pytest.mark.skipif(PLAIN, reason="hundreds of runs take minutes in plain mode")


def _ball(height: float, restitution: float) -> ns.System:
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    impact = EnergeticImpact(restitution)
    system.contact(plate, ball, normal=Unilateral(), friction=Frictionless(), impact=impact)
    system.place(ball, position=(0.0, 0.0, 0.01 + height))
    return system


FAMILY = Family(_ball, {"height": 0.1, "restitution": 0.7}, units={"height": "m"})


def test_a_line_is_the_derivative_times_the_parameter_broken_at_events() -> None:
    found = sensitivity(FAMILY, ("height",), at=np.linspace(0.02, 0.3, 15))
    axes = pictures.sensitivities(found, "vz")
    struck = math.sqrt(0.2 / 9.81)
    times, values = (np.asarray(data, dtype=float) for data in axes.lines[0].get_data())
    np.testing.assert_allclose(times[np.isnan(values)], [struck], rtol=1e-9)
    flown = 0.1 * 1.7 / struck
    np.testing.assert_allclose(values[times < struck], 0.0, atol=1e-7)
    np.testing.assert_allclose(values[times > struck], flown, rtol=1e-7)
    assert axes.get_ylabel() == "change of vz [m/s]"
    legend = axes.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["height [m] of 0.1"]
    with pytest.raises(ns.InvalidInput, match=r"Did you mean 'ball\.vz'"):
        pictures.sensitivities(found, "ball.vzz")


@pytest.mark.slow
def test_the_ellipse_of_a_fit_is_as_wide_as_its_standard_errors() -> None:
    times = np.linspace(0.02, 0.3, 12)
    exact = FAMILY.model().run(0.3).at(times)["q"][:, 2]
    noisy = np.random.default_rng(2).normal(exact, 1e-4)
    bounds = {"height": (0.05, 0.2), "restitution": (0.5, 0.9)}
    found = fit(FAMILY, bounds, at=times, measured=noisy, observe=lambda state: state.q[2], starts=2)
    upper, lower, ellipse = pictures.fitted(found, "height [m]").axes
    points = np.array(ellipse.lines[0].get_data(), dtype=float)
    for row, name in zip(points, found.values, strict=True):
        assert np.ptp(row) / 2.0 == pytest.approx(found.standard_errors[name], rel=1e-3)
    assert (ellipse.get_xlabel(), ellipse.get_ylabel()) == ("height [m]", "restitution")
    assert (upper.get_ylabel(), lower.get_ylabel()) == ("height [m]", "measured - fitted [m]")
    curve = np.array(upper.lines[0].get_data(), dtype=float)
    np.testing.assert_allclose(np.interp(times[:5], *curve), exact[:5], atol=1e-3)
    rest = np.asarray(lower.lines[0].get_data()[1], dtype=float)
    assert np.sqrt(np.sum(rest**2) / (len(times) - 2)) == pytest.approx(found.deviation)


@pytest.mark.slow
def test_one_parameter_has_no_ellipse() -> None:
    times = np.linspace(0.02, 0.1, 5)
    falls = 0.11 - 9.81 * times**2 / 2.0
    found = fit(FAMILY, {"height": (0.05, 0.2)}, at=times, measured=falls, observe=lambda state: state.q[2], starts=2)
    assert len(pictures.fitted(found, "height [m]").axes) == 2
