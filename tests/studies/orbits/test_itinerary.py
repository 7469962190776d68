"""Events over the phase of a period: of orbits where they are known in closed form, and of a run."""

from __future__ import annotations

import math

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.studies.orbits.diagram import bifurcation
from nonsmooth.studies.orbits.itinerary import itinerary_diagram, itinerary_of_run
from scenarios.bouncing_ball import BouncingBall
from scenarios.bouncing_ball.orbits import impact_phase

pytestmark = pytest.mark.skipif(PLAIN, reason="hundreds of periods take minutes in plain mode")
BALL = BouncingBall(gamma=0.8, start_phase=1.0, speed=0.25)


def test_impacts_of_orbits_are_where_the_closed_form_has_them() -> None:
    """One a period where that orbit attracts; elsewhere they repeat after as many periods as the whole motion."""
    found = itinerary_diagram(BALL, "gamma", [0.6, 0.8, 1.15], 0.04, settle=400, keep=6)
    for row, gamma in zip(found.rows[:2], (0.6, 0.8), strict=True):
        assert row.at[0] < 0.0
        phase = (impact_phase(gamma, 0.8, 1) - 1.0) / (2.0 * math.pi) % 1.0
        np.testing.assert_allclose(row.at[1:], phase + np.arange(6.0), atol=1e-6)
    (n,) = bifurcation(BALL, "gamma", [1.15], 0.04, "vz", at=0.02, settle=400).periods.tolist()
    assert n == 3
    later = found.rows[2].at[1:]
    np.testing.assert_allclose(later[later < n] + n, later[later >= n], atol=1e-4)
    assert abs(later[1] - later[0] - 1.0) > 0.1
    assert {cause for row in found.rows for cause, _ in row.events} == {Cause.IMPACT}
    assert found.failures == ("", "", "")


def test_the_rows_of_a_run_have_all_of_its_events() -> None:
    model = ns.assemble(BouncingBall(gamma=2.2, start_phase=1.0, speed=0.3).build())
    run = model.run(1.0)
    found = itinerary_of_run(model, run, 0.04)
    times = np.concatenate([0.04 * (row.at[row.at >= 0.0] + i) for i, row in enumerate(found.rows)])
    np.testing.assert_allclose(times, run.events.time[run.events.cause != Cause.START], atol=1e-12)
    assert len(found.values) == 25


def test_a_row_is_filled_from_its_begin_to_its_end() -> None:
    pytest.importorskip("matplotlib")
    found = itinerary_diagram(BALL, "gamma", [0.6, 0.8], 0.04, settle=50, keep=2)
    axes = found.draw()
    spans = [path.get_extents() for bars in axes.collections if bars.get_label() != "" for path in bars.get_paths()]
    filled = [one for one in spans if one.width > 0.0 and one.height > 0.0]
    assert sum(one.width for one in filled) == pytest.approx(2.0 * len(found.rows))
    assert axes.get_xlabel() == "phase of the period [1]"
    legend = axes.get_legend()
    assert legend is not None
    assert [text.get_text() for text in legend.get_texts()] == ["impact\nof 'plate - ball'"]


def test_over_a_frequency_the_period_is_a_function() -> None:
    """The strength stays, so that impacts of all frequencies are at one phase; a fixed period fits one value only."""
    found = itinerary_diagram(BALL, "frequency", [25.0, 26.0], lambda f: 1.0 / f, settle=200, keep=4)
    assert found.failures == ("", "")
    phase = (impact_phase(0.8, 0.8, 1) - 1.0) / (2.0 * math.pi) % 1.0
    for row in found.rows:
        np.testing.assert_allclose(row.at[1:], phase + np.arange(4.0), atol=1e-6)
    fixed = itinerary_diagram(BALL, "frequency", [25.0, 26.0], 0.04, settle=200, keep=4)
    assert fixed.failures[0] == ""
    assert fixed.failures[1].startswith("itinerary_diagram: period must be one of the system")
    assert "period=lambda" in fixed.failures[1]


def test_bad_input() -> None:
    with pytest.raises(ns.InvalidInput, match="itinerary_diagram: period must be positive and finite, but it is 0"):
        itinerary_diagram(BALL, "gamma", [0.8], 0.0)
    with pytest.raises(
        ns.InvalidInput, match=r"itinerary_diagram: period must be positive and finite at the value 0\.8"
    ):
        itinerary_diagram(BALL, "gamma", [0.8], lambda gamma: math.inf)

    with pytest.raises(ns.InvalidInput, match="itinerary_diagram: values must rise"):
        itinerary_diagram(BALL, "gamma", [0.8, 0.6], 0.04)
    with pytest.raises(ns.InvalidInput, match="itinerary_diagram: keep must be positive"):
        itinerary_diagram(BALL, "gamma", [0.8], 0.04, keep=0)
    with pytest.raises(ns.InvalidInput, match="Did you mean 'gamma'"):
        itinerary_diagram(BALL, "gama", [0.8], 0.04)
    model = ns.assemble(BALL.build())
    with pytest.raises(ns.InvalidInput, match="not longer than the run"):
        itinerary_of_run(model, model.run(0.01), 0.04)
