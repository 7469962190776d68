"""Pictures of studies: what is drawn, what is told in words, and how runs without records are marked."""

from __future__ import annotations

import io
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth import studies
from scenarios.bouncing_ball import BouncingBall
from scenarios.dumbbell import DumbbellScenario
from tests.studies.ball import T_END, drop

pytest.importorskip("zarr", "3.1.3")
CHARACTER = 6.0
"""Width of one that is drawn [pixels]."""


@pytest.mark.slow
def test_a_map_hatches_what_has_no_record(tmp_path: Path) -> None:
    axes = studies.grid(height=[-1.0, 0.01, 0.05], restitution=[0.5, 0.7])
    study = studies.Study(drop, axes, ["t_end", "impacts"], t_end=T_END)
    figure = studies.draw_study(study.run(tmp_path / "s.zarr", executor="serial"))
    assert [one.get_ylabel() for one in figure.axes] == ["height", "impacts"]
    mesh, hatched = figure.axes[0].collections
    drawn = mesh.get_array()
    assert drawn is not None
    assert np.ma.getmaskarray(drawn).tolist() == [[True, True], [False, False], [False, False]]
    assert len(hatched.get_paths()) == 2
    assert hatched.get_hatch() == "xxx"
    assert figure.get_suptitle() == f"6 runs of drop, all with t_end {T_END:g} s"
    assert [one.get_text() for one in figure.legends[0].get_texts()] == ["without records: 2 failed"]


@pytest.mark.slow
def test_classes_come_first_each_with_a_colour_of_its_own(tmp_path: Path) -> None:
    axes = studies.grid(beta0=[0.1, 0.2], phase=[0.0, 1.0])
    study = studies.Study(DumbbellScenario(mode="free", t_end=0.5), axes, ["impacts", "attractor"])
    figure = studies.draw_study(study.run(tmp_path / "s.zarr", executor="serial"))
    classes, numbers = (one for one in figure.axes if one.get_xlabel())
    mesh = classes.collections[0]
    names = DumbbellScenario.words["attractor"]
    assert len(np.unique(mesh.to_rgba(np.arange(len(names))), axis=0)) == len(names)
    bar = figure.axes[2]
    assert bar.get_ylabel() == "attractor"
    assert [one.get_text() for one in bar.get_yticklabels()] == list(names)
    assert numbers.collections[0].get_cmap().name == "viridis"
    assert figure.legends == []


def test_where_all_numbers_are_the_same_they_are_drawn(tmp_path: Path) -> None:
    study = studies.Study(BouncingBall(t_end=0.1), studies.grid(gamma=[0.5, 0.6]), ["t_end"])
    figure = studies.draw_study(study.run(tmp_path / "s.zarr", executor="serial"))
    assert figure.axes[0].get_ylabel() == "t_end [s]"
    assert figure.get_suptitle() == "2 runs of BouncingBall"


@pytest.mark.slow
def test_numbers_along_an_axis_do_not_run_together(tmp_path: Path) -> None:
    draws = studies.listed([{"gamma": 0.3, "start_phase": -0.097}, {"gamma": 0.8, "start_phase": 0.097}])
    study = studies.Study(BouncingBall(t_end=0.1), draws, ["impacts"])
    figure = studies.draw_study(study.run(tmp_path / "s.zarr", executor="serial"))
    figure.savefig(io.BytesIO(), format="png")
    for axes in figure.axes:
        boxes = [one.get_window_extent() for one in axes.get_xticklabels()]
        assert all(one.x1 + CHARACTER < other.x0 for one, other in pairwise(boxes))


def test_each_component_of_a_vector_gets_a_panel(tmp_path: Path) -> None:
    friction = studies.grid(friction=[0.1, 0.3])
    study = studies.Study(
        DumbbellScenario(t_end=0.4), friction, ["drift_velocity", studies.Trajectory("q", (0.0, 0.2))]
    )
    found = study.run(tmp_path / "s.zarr", executor="serial")
    figure = studies.draw_study(found)
    assert [one.get_ylabel() for one in figure.axes] == ["drift_velocity[0] [m/s]", "drift_velocity[1] [m/s]"]
    for part, axes in enumerate(figure.axes):
        assert np.array_equal(axes.lines[0].get_ydata(), found.drift_velocity.values[:, part])
    assert figure.get_suptitle() == "2 runs of DumbbellScenario; not drawn: q"


def test_components_of_a_state_have_the_names_and_units_of_its_coordinates(tmp_path: Path) -> None:
    study = studies.Study(drop, studies.grid(height=[0.01, 0.02]), ["q_end"], t_end=T_END)
    found = study.run(tmp_path / "s.zarr", executor="serial")
    figure = studies.draw_study(found)
    (axes,) = figure.axes
    assert axes.get_ylabel() == "q_end ball z [m]"
    assert np.array_equal(axes.lines[0].get_ydata(), found.q_end.values[:, 2])
    assert "q_end ball x 0 m" in figure.get_suptitle()


def test_a_study_of_trajectories_cannot_be_drawn(tmp_path: Path) -> None:
    record = [studies.Trajectory("q", (0.0, 0.1))]
    found = studies.Study(drop, studies.grid(height=[0.01]), record, t_end=T_END).run(tmp_path / "s.zarr")
    told = r"short vector, but it is \['q'\]. Store another record as well, .* or --record impacts"
    with pytest.raises(ns.InvalidInput, match=told):
        studies.draw_study(found)
