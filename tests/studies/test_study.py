"""What a study computes, keeps and refuses."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth import studies
from nonsmooth.engine.memory.modes import Status
from nonsmooth.interfaces import Scenario
from nonsmooth.parameters import parameter
from nonsmooth.studies import status
from nonsmooth.studies.records import Requested
from nonsmooth.studies.status import CaseStatus
from nonsmooth.studies.study_folder import StudyFolder
from scenarios.bouncing_ball import BouncingBall
from scenarios.dumbbell import DumbbellScenario
from tests.studies.ball import RECORD, T_END, draws, drop, shaken

pytest.importorskip("zarr", "3.1.3")


def _double(scenario: BouncingBall, solution: ns.Solution) -> float:
    """Twice the end [s]."""
    return 2.0 * solution.t_end


def _raises(scenario: BouncingBall, solution: ns.Solution) -> float:
    raise OverflowError("too much")


@dataclasses.dataclass(frozen=True)
class _Telling(Scenario):
    """A drop that is told of in words that nobody listed."""

    title: ClassVar[str] = "A drop"
    height: float = parameter(0.1, doc="height", unit="m", above=0.0)
    t_end: float = parameter(T_END, doc="end time", unit="s", above=0.0)
    words: ClassVar[Mapping[str, tuple[str, ...]]] = {"bounces": ("few", "many of them")}

    def build(self) -> ns.System:
        return drop(self.height)

    def summarise(self, solution: ns.Solution) -> Mapping[str, Any]:
        return {"told": "much", "bounces": "many of them" if solution.counters.impacts > 6 else "few"}

    def acceptance(self, solution: ns.Solution) -> tuple[ns.Criterion, ...]:
        return ()


@pytest.mark.slow
def test_a_study_of_a_scenario_has_what_single_runs_have(tmp_path: Path) -> None:
    scenario = BouncingBall(t_end=0.2)
    record: list[Requested] = [
        "impacts",
        "last_flight",
        "q_end",
        _double,
        studies.Trajectory("q", (0.0, 0.1)),
        "reason",
    ]
    axes = {"restitution": [0.5, 0.8], "gamma": [0.3, 0.6, 0.9]}
    found = studies.Study(scenario, studies.grid(**axes), record).run(tmp_path / "s.zarr", executor="serial")
    assert dict(found.sizes) == {"restitution": 2, "gamma": 3, "coordinate": 7, "time": 2}
    assert found.restitution.attrs["long_name"] == "energetic coefficient of restitution e"
    for e in axes["restitution"]:
        for gamma in axes["gamma"]:
            one = dataclasses.replace(scenario, restitution=e, gamma=gamma)
            run = ns.simulate(one.build(), one.t_end, sample_interval=one.sample_interval)
            row = found.sel(restitution=e, gamma=gamma)
            assert row.q_end.values.tobytes() == run.q_end.tobytes()
            assert row.q.values.tobytes() == run.at([0.0, 0.1])["q"].tobytes()
            assert (row.impacts, row._double, row.reason) == (run.counters.impacts, 0.4, Status.DONE)
            assert row.last_flight == one.summarise(run)["last_flight"]
    assert found._double.attrs == {"long_name": "Twice the end", "units": "s"}


def test_rows_of_numbers_are_kept_whole(tmp_path: Path) -> None:
    scenario = DumbbellScenario(t_end=0.4)
    found = studies.Study(scenario, studies.grid(friction=[0.1, 0.3]), ["drift_velocity"]).run(tmp_path / "s.zarr")
    assert found.drift_velocity.dims == ("friction", "drift_velocity_part")
    for friction in (0.1, 0.3):
        one = dataclasses.replace(scenario, friction=friction)
        run = ns.simulate(one.build(), one.t_end, sample_interval=one.sample_interval)
        assert found.drift_velocity.sel(friction=friction).values.tolist() == one.summarise(run)["drift_velocity"]


def test_words_are_coordinates_and_classes(tmp_path: Path) -> None:
    scenario = DumbbellScenario(t_end=1.0)
    study = studies.Study(scenario, studies.grid(mode=["jump", "drift"]), ["attractor", "period"])
    found = study.run(tmp_path / "s.zarr", executor="serial")
    assert found.mode.values.tolist() == ["jump", "drift"]
    names = found.attractor.attrs["flag_meanings"].split()
    assert [names[i] for i in found.attractor.values] == ["jump", "drift"]
    assert studies.basin_stability(found.attractor)["drift"] == (0.5, np.sqrt(0.125))
    assert studies.draw_study(found).axes[0].get_ylabel() == "attractor"


def test_words_with_blanks_are_one_word(tmp_path: Path) -> None:
    study = studies.Study(_Telling(), studies.grid(height=[0.001, 0.1]), ["bounces"])
    found = study.run(tmp_path / "s.zarr", executor="serial").bounces
    assert found.attrs["flag_meanings"] == "few many_of_them"
    assert found.values.tolist() == [1, 0]


def test_chunks_without_a_value_are_whole(tmp_path: Path) -> None:
    """Zarr leaves out chunks of nothing but what stands for no value; these were done."""
    study = studies.Study(drop, studies.grid(height=[-1.0, 0.01, -2.0]), RECORD, t_end=T_END)
    study.run(tmp_path / "s.zarr", executor="serial", chunk=1)
    assert StudyFolder(tmp_path / "s.zarr").damage() == []


def test_a_run_that_fails_is_a_row(tmp_path: Path) -> None:
    study = studies.Study(drop, studies.grid(height=[0.01, -1.0, 0.05]), [*RECORD, _raises], t_end=T_END)
    found = study.run(tmp_path / "s.zarr", executor="serial", chunk=2)
    assert found.status.values.tolist() == [CaseStatus.FAILED.code] * 3
    assert found.reason.values.tolist() == [status.RAISED] * 3
    texts = StudyFolder(tmp_path / "s.zarr").texts()
    assert texts[1] == "ArithmeticError: no ball at -1.0"
    assert "record _raises: OverflowError: too much" in texts[0]


def test_counts_are_whole_and_a_seed_is_a_parameter(tmp_path: Path) -> None:
    """The same seed gives the same run, stored with it."""
    study = studies.Study(shaken, studies.listed([{"seed": seed} for seed in (3, 7, 3)]), RECORD, t_end=T_END)
    found = study.run(tmp_path / "s.zarr", executor="threads")
    one, other, again = (found.isel(run=run) for run in range(3))
    assert one.q_end.values.tobytes() == again.q_end.values.tobytes() != other.q_end.values.tobytes()
    assert found.seed.values.tolist() == [3, 7, 3]
    assert {found[name].dtype.str for name in ("seed", "impacts", "steps")} == {"<i8"}


@pytest.mark.slow
def test_a_budget_ends_a_run_by_its_steps(tmp_path: Path) -> None:
    study = studies.Study(drop, studies.grid(restitution=[0.2, 0.9], height=[0.05]), RECORD, t_end=2.0, budget=60)
    found = study.run(tmp_path / "s.zarr", executor="serial")
    free = studies.Study(drop, studies.grid(restitution=[0.2, 0.9], height=[0.05]), RECORD, t_end=2.0)
    whole = free.run(tmp_path / "free.zarr", executor="serial")
    assert (whole.steps.values.ravel() <= 60).tolist() == [True, False]
    assert found.status.values.ravel().tolist() == [CaseStatus.DONE.code, CaseStatus.BUDGET.code]
    assert found.q_end.values[0].tobytes() == whole.q_end.values[0].tobytes()
    assert "its 60 steps were used up" in StudyFolder(tmp_path / "s.zarr").texts()[1]


def test_what_runs_are_made_of_is_written_beside_them(tmp_path: Path) -> None:
    study = studies.Study(BouncingBall(t_end=0.1), studies.sobol(4, 7, gamma=(0.3, 0.9)), ["impacts"])
    found = study.run(tmp_path / "s.zarr", executor="serial")
    spec = json.loads(found.attrs["spec"])
    assert spec["runs"]["parameters"]["t_end"] == 0.1
    assert spec["sampling"] == {"kind": "sobol", "n": 4, "seed": 7, "ranges": {"gamma": [0.3, 0.9]}}
    assert {"numpy", "engine", "processor"} <= json.loads(found.attrs["provenance"])[0].keys()
    assert found.gamma.dims == ("run",)


def test_others_open_it_without_a_warning(tmp_path: Path) -> None:
    import xarray

    studies.Study(drop, draws(3), RECORD, t_end=T_END).run(tmp_path / "s.zarr", executor="serial")
    with xarray.open_zarr(str(tmp_path / "s.zarr")) as opened:
        assert opened.sizes["run"] == 3


_BALL, _GRID = BouncingBall(t_end=0.1), studies.grid(gamma=[0.5])


def _ball(record: Requested) -> studies.Study:
    return studies.Study(BouncingBall(t_end=0.2), studies.grid(gamma=[0.5]), [record])


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: studies.Study(_BALL, studies.grid(gama=[0.5]), ["impacts"]), ("gama", "Did you mean 'gamma'")),
        (lambda: studies.Study(_BALL, studies.grid(gamma=[-0.5]), ["impacts"]), ("gamma", ">= 0", "-0.5")),
        (lambda: studies.Study(_BALL, studies.grid(gamma=["much"]), ["impacts"]), ("gamma", "numbers", "much")),
        (lambda: studies.Study(_BALL, _GRID, ["impact"]), ("impact", "Did you mean 'impacts'")),
        (lambda: studies.Study(_BALL, _GRID, ["impacts", "impacts"]), ("impacts", "once")),
        (lambda: studies.Study(_BALL, _GRID, ["impacts"], t_end=1.0), ("t_end", "left out", "1.0")),
        (lambda: studies.Study(_BALL, _GRID, ["impacts"], budget=0), ("budget", "positive", "0")),
        (lambda: studies.Study(_BALL, _GRID, "impacts"), ("record", "a list", '["impacts"]')),
        (lambda: studies.Study(_BALL, _GRID, [3]), ("record", "function", "3")),  # type: ignore[list-item]
        (lambda: studies.Study(_BALL, {"gamma": [1]}, ["impacts"]), ("sampling", "Sampling")),  # type: ignore[arg-type]
        (lambda: studies.Study(drop, _GRID, RECORD, t_end=1.0), ("gamma", "height, restitution")),
        (lambda: studies.Study(drop, studies.grid(restitution=[0.5]), RECORD, t_end=1.0), ("height", "no default")),
        (lambda: studies.Study(drop, studies.grid(height=[0.1]), RECORD), ("t_end", "positive", "None")),
        (lambda: studies.Study(lambda gamma: drop(gamma), _GRID, RECORD, t_end=1.0), ("lambda", "module")),
        (
            lambda: studies.Study(DumbbellScenario(), studies.grid(mode=["jum"]), RECORD),
            ("mode", "Did you mean 'jump'"),
        ),
        (
            lambda: studies.Study(BouncingBall(), studies.grid(t_end=[0.1, 0.2]), ["t_end"]),
            ("record t_end", "must not be a varied parameter"),
        ),
        (lambda: _ball(studies.Trajectory("q", (0.1, 0.3))), ("times", "within a run of 0.2 s", "0.3")),
        (lambda: studies.Trajectory("q", (-0.1, 0.3)), ("times", "none negative")),
        (lambda: studies.Study(_Telling(), studies.grid(height=[0.1]), ["told"]), ("told", "a row of numbers", "much")),
    ],
)
def test_what_cannot_be_run_is_refused_before_it_is(make: Callable[[], Any], words: tuple[str, ...]) -> None:
    with pytest.raises(ns.InvalidInput) as error:
        make()
    for word in words:
        assert word in str(error.value)
