"""The figures of every scenario can be saved, have titles and labels, and are drawn from the runs that they ask for."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import pytest
from matplotlib.figure import Figure

import nonsmooth as ns
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces import Scenario
from nonsmooth.plugins import registry

matplotlib.use("Agg")


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="full runs take minutes in plain mode")
@pytest.mark.parametrize("name", registry.names("scenarios"))
def test_the_gallery_says_what_it_shows(name: str, tmp_path: Path) -> None:
    owner, ran = registry.load("scenarios", name), list[Scenario]()

    def run(scenario: Scenario) -> ns.Solution:
        ran.append(scenario)
        return ns.run_scenario(scenario)

    figures = owner.gallery(run)
    assert {type(scenario) for scenario in ran} == {owner}
    for stem, figure in figures.items():
        _check(figure, stem)
        figure.savefig(tmp_path / f"{stem}.png", dpi=30)


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="full runs take minutes in plain mode")
@pytest.mark.parametrize("name", registry.names("scenarios"))
def test_a_short_run_has_figures(name: str, tmp_path: Path) -> None:
    short = registry.load("scenarios", name)()
    solution = ns.simulate(short.build(), 0.05 * short.t_end, sample_interval=short.sample_interval)
    for stem, figure in short.figures(solution).items():
        _check(figure, stem)
        figure.savefig(tmp_path / f"{stem}.png", dpi=30)


def _check(figure: Figure, stem: str) -> None:
    """A figure has a title, its lowest panels the label of the abscissa, and some panel that of the ordinate."""
    titles = [figure.get_suptitle(), *(axes.get_title() for axes in figure.axes)]
    assert any(titles), stem
    assert figure.axes[-1].get_xlabel(), stem
    assert any(axes.get_ylabel() for axes in figure.axes), stem
