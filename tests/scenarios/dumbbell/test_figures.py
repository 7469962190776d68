"""The figures: all there, each with units, legend, title and what was assumed."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from matplotlib.quiver import Quiver
from matplotlib.text import Text

import nonsmooth as ns
from nonsmooth.errors import NonsmoothWarning
from nonsmooth.parameters import with_defaults
from scenarios.dumbbell import DumbbellScenario
from scenarios.dumbbell.trace import Trace

EXPECTED = {2, 3, 4, 5, 6, 7, 8, 9, 10, 11}
Runner = Callable[..., Any]


@pytest.fixture(scope="module")
def gallery() -> dict[str, Any]:
    return dict(DumbbellScenario.gallery(ns.run_scenario))


@pytest.mark.slow
def test_gallery_has_the_figures_of_the_paper(gallery: dict[str, Any]) -> None:
    assert {int(stem[3:5]) for stem in gallery} == EXPECTED


@pytest.mark.slow
def test_every_figure_says_what_it_shows(gallery: dict[str, Any]) -> None:
    for stem, figure in gallery.items():
        assert len(figure.get_suptitle()) > 20, stem
        (legend,) = figure.legends
        assert legend.get_texts(), stem
        assert "assumed" in legend.get_title().get_text(), stem
        for axis in figure.axes:
            assert re.search(r"\[.+\]", axis.get_xlabel()), stem
        assert re.search(r"\[.+\]", figure.axes[0].get_ylabel()), stem


@pytest.mark.slow
def test_lines_differ_without_colour(gallery: dict[str, Any]) -> None:
    for stem, figure in gallery.items():
        for axis in figure.axes:
            named = {line.get_label(): line for line in axis.lines if not line.get_label().startswith("_")}
            looks = [(line.get_linestyle(), line.get_marker(), line.get_color() == "black") for line in named.values()]
            assert len(set(looks)) == len(looks), stem


@pytest.mark.parametrize(
    ("start", "stems"),
    [
        ({"mode": "drift"}, {"fig02_drift_motion", "fig03_drift_tangential_velocity", "fig09_beta", "fig11_path"}),
        # what stays as it is, or comes back to where it was, has no picture
        ({"mode": "jump"}, {"fig04_jump_motion"}),
        ({"mode": "flutter", "t_end": 8.0}, {"fig07_flutter_motion", "fig09_beta"}),
        ({"mode": "free"}, {"free_motion", "fig09_beta", "fig11_path"}),
    ],
)
def test_a_run_draws_the_figures_of_its_mode(dumbbell: Runner, start: dict[str, Any], stems: set[str]) -> None:
    run = dumbbell(**start)
    assert set(run.scenario.figures(run.solution)) == stems


def test_arrows_of_a_path_are_mean_velocities(dumbbell: Runner) -> None:
    """Those of a drift point where it goes, all of them, and not to and fro within a period."""
    run = dumbbell(mode="drift")
    (axis,) = run.scenario.figures(run.solution)["fig11_path"].axes
    (arrows,) = (found for found in axis.collections if isinstance(found, Quiver))
    x, y = run.scenario.summarise(run.solution)["drift_velocity"]
    across, along = np.asarray(arrows.U, dtype=float), np.asarray(arrows.V, dtype=float)
    assert len(along) == 6
    np.testing.assert_allclose(along[1:], y, rtol=0.05)
    np.testing.assert_allclose(across, x, atol=1e-9)


def test_balls_have_one_name_each(gallery: dict[str, Any]) -> None:
    for figure in gallery.values():
        words = " ".join(text.get_text() for text in figure.findobj(Text))
        assert not re.search(r"\b(at|of|before) [AB]\b", words)


def test_titles_do_not_promise_what_did_not_happen(dumbbell: Runner) -> None:
    run = dumbbell(gamma=0.3)
    figure = run.scenario.figures(run.solution)["fig02_drift_motion"]
    assert "rest" in figure.get_suptitle()


@pytest.mark.slow
def test_figures_with_other_parameters_state_no_result_of_the_paper() -> None:
    resting = with_defaults(DumbbellScenario, {"restitution": 0.5})
    with pytest.warns(NonsmoothWarning) as caught:
        figures = resting.gallery(ns.run_scenario)
    told = {str(one.message) for one in caught}
    constant = "is left out: its angle is constant at the end of all runs."
    assert {f"The figure {stem} {constant}" for stem in ("fig08_theta", "fig09_beta")} <= told
    assert {int(stem[3:5]) for stem in figures} == EXPECTED - {8, 9}
    for stem in ("fig10_gamma", "fig11_paths"):
        title = figures[stem].get_suptitle()
        assert "(attractors: rest from the start of drift, " in title
        assert not re.search("circles|straight|zigzags|open|rolls", title)
        assert all(axes.lines for axes in figures[stem].axes)


def test_titles_of_the_gallery_state_the_results_of_the_paper(gallery: dict[str, Any]) -> None:
    assert "drift circles, jump goes straight, flutter zigzags" in gallery["fig11_paths"].get_suptitle()
    assert "open in all three modes" in gallery["fig10_gamma"].get_suptitle()


@pytest.mark.slow
def test_figures_of_the_shortest_run_can_be_drawn(dumbbell: Runner, tmp_path: Any) -> None:
    run = dumbbell(mode="jump", t_end=2e-3)
    for stem, figure in run.scenario.figures(run.solution).items():
        figure.savefig(tmp_path / f"{stem}.png", dpi=30)


def test_trace_jumps_at_events_and_nowhere_else(dumbbell: Runner) -> None:
    run = dumbbell(mode="flutter")
    trace = Trace.of(run.scenario, run.solution, 10.0)
    jumps = np.abs(np.diff(trace.motion.u[:, 4])) > 1.0
    assert jumps.sum() == pytest.approx(10, abs=1)
    assert np.array_equal(jumps, np.asarray(trace.struck.any(axis=1))[:-1])
    np.testing.assert_allclose(trace.motion.slip[0, 0], 0.0, atol=1e-12)
