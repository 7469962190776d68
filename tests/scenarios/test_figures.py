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

NAMES: dict[str, tuple[str, str]] = {
    "ball_box": ("history pile", "history pile"),
    "bead_column": ("heights_dissipative heights_elastic", "heights"),
    "block_on_belt": ("limit_cycle", "portrait"),
    "bouncing_ball": ("bifurcation motions", "motion"),
    "bouncing_trimer": ("gaps path regimes", "gaps path"),
    "dice_throw": ("throw", "throw"),
    "disc_ball": ("offset stiffness strike", "strike"),
    "dominoes": ("row wave", "row wave"),
    "dumbbell": (
        "fig02_drift_motion fig03_drift_tangential_velocity fig04_jump_motion fig05_jump_tilted_motion "
        "fig06_jump_tilted_normal_velocity fig07_flutter_motion fig08_theta fig09_beta fig10_gamma fig11_paths",
        "fig02_drift_motion fig03_drift_tangential_velocity fig09_beta",
    ),
    "egg_on_table": ("friction history jumps spin", "history"),
    "mesh_drop": ("history poses", "history poses"),
    "mesh_dumbbell": ("gaps", "gaps"),
    "newtons_cradle": ("velocities_hertz velocities_linear", "velocities"),
    "polyhedron_stack": ("tower", "tower"),
    "rattleback": ("friction history sense", "history"),
    "rocking_block": ("corners rocking velocity_ratio", "corners"),
    "rocking_block_3d": ("spatial", "spatial"),
    "rolling_disc": ("paths settling", "paths settling"),
    "slider_crank": ("heights", "height"),
    "sliding_rod": ("histories paradox", "history"),
    "tippe_top": ("contact_radius history spin", "history"),
    "two_link_arm": ("bouncing critical_friction", "gap"),
    "woodpecker": ("cycles limit_cycles", "cycles"),
}
"""File names of the gallery, and of the figures of a short run."""


def test_all_are_there() -> None:
    assert set(NAMES) == set(registry.names("scenarios"))


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="full runs take minutes in plain mode")
@pytest.mark.parametrize("name", NAMES)
def test_the_gallery_says_what_it_shows(name: str, tmp_path: Path) -> None:
    owner, ran = registry.load("scenarios", name), list[Scenario]()

    def run(scenario: Scenario) -> ns.Solution:
        ran.append(scenario)
        return ns.run_scenario(scenario)

    figures = owner.gallery(run)
    assert {type(scenario) for scenario in ran} == {owner}
    assert sorted(figures) == NAMES[name][0].split()
    for stem, figure in figures.items():
        _check(figure, stem)
        figure.savefig(tmp_path / f"{stem}.png", dpi=30)


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="full runs take minutes in plain mode")
@pytest.mark.parametrize("name", NAMES)
def test_a_short_run_has_figures(name: str, tmp_path: Path) -> None:
    short = registry.load("scenarios", name)()
    solution = ns.simulate(short.build(), 0.05 * short.t_end, sample_interval=short.sample_interval)
    figures = short.figures(solution)
    assert sorted(figures) == NAMES[name][1].split()
    for stem, figure in figures.items():
        _check(figure, stem)
        figure.savefig(tmp_path / f"{stem}.png", dpi=30)


def _check(figure: Figure, stem: str) -> None:
    """A figure has a title, its lowest panels the label of the abscissa, and some panel that of the ordinate."""
    titles = [figure.get_suptitle(), *(axes.get_title() for axes in figure.axes)]
    assert any(titles), stem
    assert figure.axes[-1].get_xlabel(), stem
    assert any(axes.get_ylabel() for axes in figure.axes), stem
