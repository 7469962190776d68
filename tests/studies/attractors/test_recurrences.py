"""What repeats, and which runs come to the same points."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from nonsmooth import studies
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.studies.attractors.linkage import hausdorff, linked
from nonsmooth.studies.status import CaseStatus
from nonsmooth.studies.study_folder import StudyFolder
from scenarios.bouncing_ball import orbits
from scenarios.bouncing_ball.scenario import GRAVITY, BouncingBall
from scenarios.dumbbell import DumbbellScenario
from tests.studies.attractors.made import Floats, logistic, study

pytest.importorskip("zarr", "3.1.3")
runs = pytest.mark.skipif(PLAIN, reason="thousands of periods take minutes in plain mode")

_T = 0.04
_STROBE = studies.Stroboscope(_T, ("z", "vz"), keep=16, at=0.5 * _T, phase="start_phase")


def _orbit(scenario: BouncingBall, n: int) -> Floats:
    """Return where the orbit whose flights take n periods is at half of each of them, in closed form."""
    theta = orbits.impact_phase(scenario.gamma, scenario.restitution, n)
    rise, tau = 0.5 * GRAVITY * n * _T, ((math.pi - theta) / (2.0 * math.pi) + np.arange(n)) * _T
    height = scenario.radius + scenario.amplitude * math.sin(theta) + rise * tau - 0.5 * GRAVITY * tau**2
    return np.stack([height, rise - GRAVITY * tau], axis=1)


@pytest.mark.slow
@runs
def test_the_ball_bounces_in_one_period_in_two_or_rests(tmp_path: Path) -> None:
    """Between the folds of n = 2 and n = 3 there are both orbits, and rest, as the table never pushes a ball off."""
    scenario = BouncingBall(gamma=0.8, t_end=6.0)
    assert orbits.existence(0.8, 2) < 0.8 < min(1.0, orbits.existence(0.8, 3), orbits.stability(0.8, 1))
    phases, speeds = np.meshgrid(np.linspace(0.0, 6.0, 5), [0.05, 0.15, 0.2, 0.36, 0.42], indexing="ij")
    starts = {"start_phase": phases.ravel(), "speed": speeds.ravel(), "orbit": np.ones(25)}
    # the study checks least and greatest value before it runs; 1.5 periods fail in their run
    starts["orbit"][3:5] = 1.5, 2.0
    record: list[Any] = [_STROBE, "last_flight", "resting_share"]
    found = studies.Study(scenario, studies.columns(starts), record).run(tmp_path / "s.zarr")
    told = studies.recurrences(found)
    assert found.status.values[3] == CaseStatus.FAILED.code
    assert (told.attractor.values[3], told.period.values[3]) == (-1, -1)

    rest = np.array([[scenario.radius, -2.0 * math.pi * scenario.amplitude / _T]])
    closed = {"rest": rest, "n = 1": _orbit(scenario, 1), "n = 2": _orbit(scenario, 2)}
    seen = dict[int, str]()
    for run in np.flatnonzero(found.status.values != CaseStatus.FAILED.code).tolist():
        points = found.stroboscopic.values[run]
        name = next(name for name, orbit in closed.items() if hausdorff(points, orbit) < 1e-6)
        assert seen.setdefault(int(told.attractor.values[run]), name) == name
        assert told.period.values[run] == len(closed[name])
        assert (found.resting_share.values[run] > 0.0) == (name == "rest")
    assert sorted(seen.values()) == sorted(closed)
    shares = studies.basin_stability(told.attractor)
    assert sum(share for share, _ in shares.values()) == pytest.approx(1.0)
    assert [word.partition("_")[2] for word in shares].count("period_1") == 2


@pytest.mark.slow
@runs
def test_below_its_fold_there_is_rest_alone_and_far_above_one_set_that_does_not_repeat(tmp_path: Path) -> None:
    draws = studies.random(8, 5, start_phase=(0.0, 6.28), speed=(0.1, 0.4))
    below = BouncingBall(gamma=0.98 * orbits.existence(0.8, 1), t_end=4.0)
    found = studies.recurrences(studies.Study(below, draws, [_STROBE]).run(tmp_path / "below.zarr"))
    assert studies.basin_stability(found.attractor) == {"A1_period_1": (1.0, 0.0)}
    strobe = studies.Stroboscope(_T, ("z", "vz"), keep=74, at=0.5 * _T, phase="start_phase")
    found = studies.recurrences(studies.Study(BouncingBall(gamma=2.2), draws, [strobe]).run(tmp_path / "above.zarr"))
    assert studies.basin_stability(found.attractor) == {"A1_aperiodic": (1.0, 0.0)}
    assert (found.period == 0).all()


@pytest.mark.slow
@runs
def test_they_agree_with_the_classifier_of_the_dumbbell(tmp_path: Path) -> None:
    """Runs to which it gives a name go to one attractor where they have the same one; "other" may be many."""
    strobe = studies.Stroboscope(_T, ("z", "q2", "vz", "wy"), at=0.5 * _T, phase="phase")
    scenario = DumbbellScenario(mode="free", aspect_ratio=5.7, restitution=0.8)
    starts = studies.grid(beta0=[0.0, 0.1, 0.25, 0.35], phase=[0.0, 3.0, 4.5])
    found = studies.Study(scenario, starts, [strobe, "attractor"]).run(tmp_path / "s.zarr")
    told = studies.recurrences(found)
    assert told.attractor.dims == ("beta0", "phase")
    names = np.array(found.attractor.attrs["flag_meanings"].split())[found.attractor.values.ravel()]
    mine = told.attractor.values.ravel()
    assert {"rest", "drift"} <= set(names)
    for one, same in zip(names, mine, strict=True):
        if one != "other":
            np.testing.assert_array_equal(names == one, mine == same)


@runs
def test_runs_whose_drive_has_another_period_fail_by_name(tmp_path: Path) -> None:
    """Some fly for two periods on end, and nothing drives them in between."""
    over = studies.grid(frequency=[24.0, 25.0, 50.0], speed=[0.1, 0.2])
    study = studies.Study(BouncingBall(gamma=0.8, t_end=3.0), over, [_STROBE])
    found = study.run(tmp_path / "s.zarr", executor="serial")
    np.testing.assert_array_equal(
        found.status, np.array([[CaseStatus.FAILED.code] * 2, [CaseStatus.DONE.code] * 2, [CaseStatus.DONE.code] * 2])
    )
    for text in StudyFolder(tmp_path / "s.zarr").texts().values():
        assert "Stroboscope: period must be one of the system" in text
        assert "a study of its own for each of its values" in text


def test_orbits_of_one_period_are_told_apart_by_their_points() -> None:
    two = logistic(3.2, np.linspace(0.1, 0.9, 5))
    shifted = np.concatenate([two[:3], two[3:] + 1.0, two[:1] + 0.5e-3])
    found = studies.recurrences(study({}, stroboscopic=shifted), tolerance=1e-4)
    assert found.period.values.tolist() == [2] * 6
    assert found.attractor.values.tolist() == [0, 0, 0, 1, 1, 0]
    assert found.attractor.attrs["flag_meanings"] == "A1_period_2 A2_period_2"
    # the largest one is the first one; of two that are as large, that of the first run
    found = studies.recurrences(study({}, stroboscopic=shifted[1:5][::-1]), tolerance=1e-3)
    assert found.attractor.values.tolist() == [0, 0, 1, 1]


def test_what_settles_slowly_does_not_repeat() -> None:
    """Each look differs from the one before by less than the tolerance, the first from the last by more."""
    looks = np.arange(32)
    points = np.stack([0.9**looks, 0.5 * 0.99**looks, 0.001 * 0.99**looks])[:, :, np.newaxis]
    assert np.abs(np.diff(points[1], axis=0)).max() < 0.01
    assert studies.recurrences(study({}, stroboscopic=points), tolerance=0.01).period.values.tolist() == [0, 0, 1]


def test_a_sample_of_a_chaotic_set_is_of_that_set() -> None:
    for r in (3.7, 3.99):
        points = logistic(r, np.random.default_rng(1).uniform(0.1, 0.9, 150), keep=32)
        assert set(studies.recurrences(study({}, stroboscopic=points)).attractor.values.tolist()) == {0}


def test_sets_that_do_not_repeat_are_told_apart_and_from_runs_that_have_not_settled() -> None:
    chaos = logistic(3.9, np.random.default_rng(1).uniform(0.1, 0.9, 9))
    slow = np.linspace(5.0, 6.0, 64)[np.newaxis, :, np.newaxis]
    points = np.concatenate([chaos[:5], chaos[5:] + 0.8, slow, slow])
    found = studies.recurrences(study({}, failed=(10,), stroboscopic=points))
    assert found.attractor.values.tolist() == [0] * 5 + [1] * 4 + [2, -1]
    assert found.attractor.attrs["flag_meanings"] == "A1_aperiodic A2_aperiodic unsettled"
    assert found.period.values.tolist() == [0] * 10 + [-1]


def test_single_linkage_is_that_of_all_pairs() -> None:
    """Against scipy's, which looks at all pairs."""
    from scipy.cluster.hierarchy import fcluster, linkage

    rng = np.random.default_rng(2)
    for n, spread in ((100, 12.0), (300, 20.0), (50, 10.0)):
        points = rng.uniform(-spread, spread, (n, 2))
        mine = linked(points)
        other = fcluster(linkage(points, "single", "chebyshev"), 1.0, "distance")
        assert len({*zip(mine.tolist(), other.tolist(), strict=True)}) == len(set(mine.tolist())) == other.max()
        assert 1 < other.max() < n


_BALL = BouncingBall(t_end=0.2)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: studies.Stroboscope(0.0, ("z",)), ("period", "positive")),
        (lambda: studies.Stroboscope(_T, ()), ("within", "names")),
        (lambda: studies.Stroboscope(_T, ("z", "z")), ("within", "once")),
        (lambda: studies.Stroboscope(_T, ("z",), keep=1), ("keep", "2 on")),
        (lambda: studies.Stroboscope(_T, ("z",), at=_T), ("at", "within a period")),
        (lambda: _study(studies.Stroboscope(_T, ("z", "ball.vy2"))), ("ball.vy2", "Did you mean 'ball.vy'")),
        (lambda: _study(studies.Stroboscope(_T, ("z",), keep=7)), ("keep", "short enough for a run of 0.2 s")),
        (lambda: _study(studies.Stroboscope(_T, ("z",), keep=2, phase="phase")), ("phase", "start_phase")),
        (lambda: studies.recurrences(study({}, other=[1.0])), ("stroboscopic", "Stroboscope")),
        (lambda: studies.recurrences(study({}, stroboscopic=np.ones((1, 4, 1))), 0.0), ("tolerance", "positive")),
    ],
)
def test_what_is_not_valid(make: Callable[[], Any], words: tuple[str, ...]) -> None:
    with pytest.raises(ns.InvalidInput) as error:
        make()
    for word in words:
        assert word in str(error.value)


def _study(strobe: studies.Stroboscope) -> studies.Study:
    return studies.Study(_BALL, studies.grid(gamma=[0.5]), [strobe])


@runs
def test_a_multiple_of_the_period_sees_the_same_phase(tmp_path: Path) -> None:
    """A ball at rest on the table is at one height at this phase, whatever the phase of the drive at the start."""
    starts = studies.grid(start_phase=[0.0, 1.0, 3.0], speed=[0.01])
    scenario = BouncingBall(gamma=0.3, t_end=2.0)
    heights = []
    for n in (1, 2, 3):
        strobe = studies.Stroboscope(n * _T, ("z", "vz"), keep=4, at=0.3 * _T, phase="start_phase")
        found = studies.Study(scenario, starts, [strobe]).run(tmp_path / f"{n}.zarr")
        heights.append(found.stroboscopic.values[..., 0].ravel())
    table = scenario.radius + scenario.amplitude * math.sin(0.6 * math.pi)
    np.testing.assert_allclose(np.concatenate(heights), table, rtol=0, atol=1e-9)
