"""What only an engine knows of a run reaches the user: contacts, a verdict, causes, and what it promises."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth import plot
from nonsmooth.cli.report import run_report as report
from nonsmooth.interfaces import EndCause, Engine, Measure
from nonsmooth.solution import modes
from tests.runs.faulty_engines import Blind
from tests.runs.reporting_engines import IMPULSE, Judged, Resting


def _lying(height: float = 0.0) -> ns.System:
    plate, ball = Plate(), Ball(0.02)
    system = ns.System([plate, ball])
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5))
    system.place(ball, position=(0.0, 0.0, 0.02 + height))
    return system


def _falling() -> ns.System:
    ball = Ball(0.02)
    system = ns.System([ball], 10.0)
    system.place(ball, position=(0.0, 0.0, 1.0))
    return system


def test_modes_and_impulses_are_those_that_the_engine_recorded() -> None:
    """At all samples, and in the words of modes and the graph."""
    run = ns.simulate(_lying(), 0.1, sample_interval=0.02, engine=Resting())
    assert run.status == "done"
    np.testing.assert_array_equal(run.at()["mode"], np.ones((6, 1)))
    assert run.history("mode_word")["mode_word"].tolist() == 6 * ["{1,0,0}"]
    assert modes.mode_shares(run) == {"{1,0,0}": 1.0}
    assert run.events.causes() == ["start", *(5 * ["step of the engine"])]
    impulses = run.history("normal_impulse", "impulse_normal")
    assert impulses["normal_impulse"].tolist() == 6 * [IMPULSE]
    np.testing.assert_allclose(impulses["impulse_normal"], np.tile([0.0, 0.0, 1.0], (6, 1)), atol=1e-15)
    with pytest.raises(ns.InvalidInput, match=r"with its forces only where .* uses the flow .* but it is Resting"):
        run.history("normal_force")


ASKED: dict[str, Callable[[ns.Solution], Any]] = {
    "Solution.history": lambda run: run.history("mode"),
    "Solution.history(?#words)": lambda run: run.history("mode_word", times=0.05),
    "Solution.history(?#impulses)": lambda run: run.history("normal_impulse"),
    "nonsmooth.solution.modes.mode_shares": modes.mode_shares,
    "nonsmooth.solution.modes.transitions": modes.transitions,
    "nonsmooth.solution.modes.transition_graph": modes.transition_graph,
    "nonsmooth.plot.modes": lambda run: plot.modes(run),
}


@pytest.fixture(scope="module")
def unrecorded() -> ns.Solution:
    return ns.simulate(_lying(0.1), 0.1, sample_interval=0.02, engine=Blind())


@pytest.mark.parametrize("name", ASKED)
def test_what_no_engine_recorded_is_refused(unrecorded: ns.Solution, name: str) -> None:
    """By the name of the engine, and not answered by zeros."""
    with pytest.raises(ns.InvalidInput, match=rf"^{name}: \w+ of contacts are known only .* it is Blind.*EventDriven"):
        ASKED[name](unrecorded)


def test_what_does_not_need_modes_is_there(unrecorded: ns.Solution, tmp_path: Path) -> None:
    np.testing.assert_array_equal(unrecorded.at()["q"], unrecorded.q)
    assert unrecorded.history("gap")["gap"][0] == pytest.approx(0.1)
    assert unrecorded.to_html(tmp_path / "run.html").stat().st_size > 0
    assert unrecorded.export(tmp_path / "run.glb").stat().st_size > 0
    said = report.as_text({"scenario": "it", "status": "done", "summary": {}, "units": {}, **_told(unrecorded)})
    assert "unknown: the engine records no modes" in said


def test_events_must_be_what_the_engine_says_of_them() -> None:
    """None with contacts whose modes would be zeros, and one at the start."""
    with pytest.raises(ns.InvalidInput, match=r"^Resting.advance must record no event .* but it is '6 events'"):
        ns.simulate(_lying(), 0.1, sample_interval=0.02, engine=Resting(tells=False))
    with pytest.raises(ns.InvalidInput, match=r"^Resting.advance must record an event at the start.*t = 0.01 s"):
        ns.simulate(_lying(), 0.1, sample_interval=0.02, engine=Resting(first=0.5))


def _told(run: ns.Solution) -> dict[str, Any]:
    return report.of_solution(run)


def test_the_verdict_is_in_the_solution_the_report_and_the_folder(tmp_path: Path) -> None:
    run = ns.simulate(_falling(), 0.1, engine=Judged(), output=tmp_path)
    assert run.end.measured == {"fastest_fall": pytest.approx(1.0)}
    told = {"scenario": "it", "status": "done", "summary": {}, "units": {}, **_told(run)}
    said = json.loads(report.as_json(told))
    meaning = "largest speed downwards at the end of a step"
    value = run.end.measured["fastest_fall"]
    assert said["verdict"] == {"fastest_fall": {"value": value, "unit": "m/s", "meaning": meaning}}
    assert said["cause"] == ""
    assert f"fastest fall      1 m/s, {meaning}" in report.as_text(told)
    found = ns.open_solution(tmp_path)
    assert found.end.verdict == run.end.verdict
    assert ns.simulate(_falling(), 0.1).end.measured == {}


def test_the_verdict_goes_on_with_the_run_and_not_with_the_model() -> None:
    model = ns.assemble(_falling(), Judged())
    half, fresh = model.run(0.05), model.run(0.02)
    speeds = [run.end.measured["fastest_fall"] for run in (half, fresh, model.run(0.1, start=half.state))]
    assert speeds == pytest.approx([0.5, 0.2, 1.0])


@pytest.mark.parametrize("height", [0.0, 0.1])
def test_a_folder_knows_whether_contacts_were_recorded(tmp_path: Path, height: float) -> None:
    """Although the engine cannot be loaded."""
    ns.simulate(_lying(height), 0.1, sample_interval=0.02, engine=Blind() if height else Resting(), output=tmp_path)
    found = ns.open_solution(tmp_path)
    if height:
        with pytest.raises(ns.InvalidInput, match=r"known only .*Blind"):
            found.history("mode")
    else:
        np.testing.assert_array_equal(found.at()["mode"], np.ones((6, 1)))


def test_a_cause_of_the_engine_fails_a_run_by_name(tmp_path: Path) -> None:
    with pytest.raises(ns.RunFailed, match=r"At t = 0\.051 s the body falls too fast\. Take a parachute\.") as failed:
        ns.simulate(_falling(), 0.1, engine=Judged(most=0.505), output=tmp_path)
    run = failed.value.solution
    assert isinstance(run, ns.Solution)
    assert (run.status, run.end.cause) == ("failed", "too_fast")
    assert run.end.measured["fastest_fall"] == pytest.approx(0.51)
    assert ns.open_solution(tmp_path).end.cause == "too_fast"
    told = {"scenario": "it", "status": run.status, "summary": {}, "units": {}, **_told(run)}
    assert report.as_text(told).startswith("it: failed (too_fast) at t = 0.051 s")
    assert json.loads(report.as_json(told))["cause"] == "too_fast"


def test_a_cause_of_the_engine_may_end_a_run_well() -> None:
    model = ns.assemble(_falling(), Judged(enough=0.505))
    run = model.run(0.1)
    assert (run.status, run.end.cause) == ("done", "fast_enough")
    assert run.t_end == pytest.approx(0.051)
    assert "the body falls fast enough" in run.message


def test_the_residual_that_an_engine_promises_decides() -> None:
    """Of 1 J exchanged a hundredth is missing."""
    system = _falling()
    good = ns.simulate(system, 0.1, engine=Judged())
    gain = 0.01 * good.energy.scale / 50
    kept, broken, without = (
        ns.simulate(system, 0.1, engine=Judged(gain=gain, promise=promise)) for promise in (0.0101, 0.0099, 0.0)
    )
    assert (good.status, kept.status, broken.status, without.status) == ("done", "done", "suspect", "suspect")
    assert "0.01 of what was exchanged, of which Judged promises 0.0099 at most." in broken.message
    assert "Most of it came about from t = 0.05" in broken.message
    assert broken.message.endswith("gain=...), or by nonsmooth.EventDriven()")
    assert "Compare the run with one by other options, Judged(step=..., " in broken.message
    assert "EventDriven(tolerance=" in without.message


class NoScalar(Judged):
    @property
    def verdict(self) -> tuple[Measure, ...]:
        return (Measure("deepest", "m", "nothing"),)


class TakenCode(Judged):
    @property
    def causes(self) -> tuple[EndCause, ...]:
        return (EndCause(99, "early", "nothing"),)


class OneCode(Judged):
    @property
    def causes(self) -> tuple[EndCause, ...]:
        return (EndCause(100, "one", "nothing"), EndCause(100, "two", "nothing"))


class Boastful(Judged):
    @property
    def promised_residual(self) -> float:
        return -1.0


@pytest.mark.parametrize(
    ("engine", "message"),
    [
        (NoScalar(), "Unknown NoScalar.verdict 'deepest'.*Known: fastest_fall"),
        (TakenCode(), r"TakenCode.causes must have different codes, 100 or more, but it is \[99\]"),
        (OneCode(), r"OneCode.causes must have different codes.*\[100, 100\]"),
        (Boastful(), "Boastful.promised_residual must be a positive finite number or None, but it is -1.0"),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, Engine) else "",
)
def test_what_an_engine_cannot_report_is_refused(engine: Engine, message: str) -> None:
    with pytest.raises(ns.InvalidInput, match=message):
        ns.assemble(_falling(), engine)
