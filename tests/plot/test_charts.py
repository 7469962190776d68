"""Charts of arrays: panels, legends, and what is drawn where."""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from nonsmooth import charts

T = np.linspace(0.0, 1.0, 11)
PAIR = {"one": (T, T), "two": (T, T**2)}


def _legends(figure: Figure) -> list[list[str]]:
    own = [found for ax in figure.axes if (found := ax.get_legend()) is not None]
    return [[text.get_text() for text in legend.get_texts()] for legend in [*figure.legends, *own]]


def test_histories_have_a_panel_a_quantity() -> None:
    figure = charts.histories({"x [m]": PAIR, "v [m/s]": {"": (T, np.cos(T))}}, "It moves")
    assert [ax.get_ylabel() for ax in figure.axes] == ["x [m]", "v [m/s]"]
    assert [ax.get_xlabel() for ax in figure.axes] == ["", "time [s]"]
    np.testing.assert_array_equal(figure.axes[0].lines[1].get_ydata(), T**2)
    assert figure.get_suptitle() == "It moves"
    assert _legends(figure) == [["one", "two"]]


@pytest.mark.parametrize(
    ("second", "legends"),
    [(PAIR, [["one", "two"]]), ({"three": (T, T)}, [["one", "two"], ["three"]])],
)
def test_panels_of_the_same_curves_share_a_legend(second: Any, legends: list[list[str]]) -> None:
    assert _legends(charts.histories({"a": PAIR, "b": second})) == legends


def test_a_portrait_marks_the_starts() -> None:
    figure = charts.portrait(PAIR, "q [m]", "velocity [m/s]")
    (ax,) = figure.axes
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("q [m]", "velocity [m/s]")
    starts = [line.get_xydata() for line in ax.lines if line.get_marker() == "o"]
    np.testing.assert_array_equal(starts, [[(0.0, 0.0)]] * 2)


def test_a_comparison_has_lines_for_theory_and_markers_for_results() -> None:
    (ax,) = charts.comparison({"theory": (T, T)}, {"run": (T[::5], T[::5])}, "x", "y").axes
    theory, run = ax.lines
    assert (theory.get_linestyle(), theory.get_marker()) == ("-", "None")
    assert (run.get_linestyle(), run.get_marker()) == ("None", "s")


def test_they_are_composed() -> None:
    figure, (left, right) = charts.panels(1, 2, "Both")
    charts.portrait(PAIR, "q", "v", ax=left)
    charts.histories({"q": PAIR}, axes=[right])
    charts.legend(figure, note="assumed: all")
    assert _legends(figure) == [["one", "two"]]
    assert figure.legends[0].get_title().get_text() == "assumed: all"
    figure.draw_without_rendering()
    assert figure.legends[0].get_window_extent().y1 <= left.get_window_extent().y0


@pytest.mark.parametrize(("entries", "columns"), [(1, 1), (3, 3), (4, 2), (5, 3), (7, 3)])
def test_a_legend_has_rows_of_about_equal_length(entries: int, columns: int) -> None:
    figure = charts.histories({"x [m]": {f"run {i}": (T, i * T) for i in range(entries)}})
    figure.draw_without_rendering()
    places = [text.get_window_extent().x0 for text in figure.legends[0].get_texts()]
    assert len({round(place) for place in places}) == columns


def test_styles_differ_without_colour() -> None:
    lines = [charts.line(place) for place in range(16)]
    assert len({(str(style["linestyle"]), style["linewidth"]) for style in lines}) == 16
    assert all(one["marker"] != other["marker"] for one, other in pairwise(map(charts.marker, range(8))))
