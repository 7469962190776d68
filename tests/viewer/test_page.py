"""What a page says of a run is what the run was."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Ball, Plate
from nonsmooth.plugins import registry
from nonsmooth.viewer.page import page
from tests.viewer.decoded import decoded

RUNS = ("dumbbell", "woodpecker", "newtons_cradle", "dominoes")


def _run(name: str, t_end: float = 0.3) -> ns.Solution:
    scenario = registry.load("scenarios", name)(t_end=t_end)
    return ns.simulate(scenario.build(), t_end, sample_interval=scenario.sample_interval)


@pytest.fixture(scope="module", params=RUNS)
def run(request: pytest.FixtureRequest) -> ns.Solution:
    """Return a run."""
    return _run(request.param)


@pytest.mark.fast_cases(1)
def test_events_are_those_of_the_run(run: ns.Solution) -> None:
    told, arrays = decoded(page(run, "", 4000))
    events = run.events
    np.testing.assert_array_equal(arrays["event_time"], events.time)
    np.testing.assert_array_equal(arrays["time"][arrays["event_knot"]], events.time)
    assert [told["causes"][code] for code in arrays["event_cause"]] == events.causes()
    names = [contact["name"] for contact in told["contacts"]]
    assert names == list(run.system.names.contacts)
    words = np.array(told["words"])[arrays["event_words"]].reshape(-1, 3)
    if events.n_contacts <= 12:
        for i, which in enumerate(("before", "during", "after")):
            assert words[:, i].tolist() == events.words(which)
    else:
        assert max(len(word) for word in told["words"]) < 120


@pytest.mark.fast_cases(1)
def test_bodies_are_where_they_were(run: ns.Solution) -> None:
    told, arrays = decoded(page(run, "", 4000))
    frame = 0
    span = float(np.linalg.norm(np.subtract(told["high"], told["low"])))
    for body in run.system.bodies:
        poses = run.history("position", "rotation", times=arrays["time"], of=body)
        for offset in range(len(body.frames)):
            np.testing.assert_allclose(
                arrays["origin"][:, frame + offset], poses["position"][:, offset], atol=1e-6 * span
            )
            turns = Rotation.from_quat(arrays["turn"][:, frame + offset].astype(float))
            apart = turns.inv() * Rotation.from_matrix(poses["rotation"][:, offset])
            assert np.max(apart.magnitude()) < 2e-4
        frame += len(body.frames)


@pytest.mark.fast_cases(1)
def test_energies_step_at_events_by_what_is_lost_there(run: ns.Solution) -> None:
    _, arrays = decoded(page(run, "", 4000))
    events = run.events
    after, before = arrays["energy"][arrays["instant_knot"]], arrays["energy_before"]
    lost = np.bincount(
        np.unique(events.time, return_inverse=True)[1],
        events.restitution_loss + events.friction_loss + events.closing_loss - events.driven_work,
    )
    scale = np.max(np.abs(arrays["energy"]))
    np.testing.assert_allclose(before[:, 0] - after[:, 0], lost, atol=1e-6 * scale)
    np.testing.assert_array_equal(before[:, 1], after[:, 1])


@pytest.mark.fast_cases(1)
def test_impulses_are_those_that_moving_bodies_got(run: ns.Solution) -> None:
    _, arrays = decoded(page(run, "", 4000))
    found = np.linalg.norm(arrays["event_push"] + arrays["event_rub"], axis=1)
    true = np.linalg.norm(run.events.listed_impulse, axis=1)
    np.testing.assert_allclose(found, true, atol=1e-6 * np.max(true))


def test_momentum_is_changed_by_the_impulses_that_are_drawn() -> None:
    ball = Ball(0.01)
    system = ns.System([Plate(), ball])
    from laws import Coulomb, EnergeticImpact, Unilateral

    system.contact(system.bodies[0], ball, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.7))
    system.place(ball, position=(0.0, 0.0, 0.02), velocity=(0.5, 0.2, -1.0))
    run = ns.simulate(system, 0.05)
    _, arrays = decoded(page(run, "", 4000))
    push = arrays["event_push"] + arrays["event_rub"]
    first = int(np.flatnonzero(run.events.causes() == np.array("impact"))[0])
    entry = int(arrays["event_first"][first])
    change = ball.total_mass * (run.events.u_after[first, :3] - run.events.u_before[first, :3])
    np.testing.assert_allclose(push[entry], change, rtol=1e-6)
    np.testing.assert_allclose(arrays["event_point"][entry][2], 0.0, atol=1e-7)


@pytest.mark.slow
def test_the_same_run_gives_the_same_page() -> None:
    assert page(_run("dumbbell"), "a", 4000) == page(_run("dumbbell"), "a", 4000)


def test_a_title_cannot_break_out_of_the_page() -> None:
    text = page(_run("bouncing_ball"), "</script><b>x", 4000)
    assert decoded(text)[0]["title"] == "</script><b>x"
    assert "</script><b>" not in text


@pytest.mark.slow
def test_a_page_without_a_title_names_the_bodies() -> None:
    balls = [Ball(0.01) for _ in range(3)]
    system = ns.System([Plate(), *balls])
    for i, ball in enumerate(balls):
        system.place(ball, position=(0.05 * i, 0.0, 1.0))
    for pair in combinations(system.bodies, 2):
        system.exclude(*pair)
    run = ns.simulate(system, 0.01)
    assert decoded(page(run, "", 4000))[0]["title"] == "plate, 3\u00a0\u00d7\u00a0ball"
    assert decoded(page(run, "Fall", 4000))[0]["title"] == "Fall"


@pytest.mark.slow
def test_of_many_kinds_of_bodies_a_title_names_some() -> None:
    balls = [Ball(0.01) for _ in range(5)]
    system = ns.System(balls)
    for i, (ball, name) in enumerate(zip(balls, ("one", "two", "three", "four", "five"), strict=True)):
        system.name(ball, name)
        system.place(ball, position=(0.05 * i, 0.0, 1.0))
    for pair in combinations(balls, 2):
        system.exclude(*pair)
    assert decoded(page(ns.simulate(system, 0.01), "", 4000))[0]["title"] == "one, two, three, four, …"


def test_a_run_without_contacts_or_events_has_a_page() -> None:
    ball = Ball(0.01)
    system = ns.System([ball])
    told, arrays = decoded(page(ns.simulate(system, 0.1), "", 4000))
    assert told["contacts"] == []
    assert np.all(np.diff(arrays["time"]) > 0.0)


@pytest.mark.slow
def test_a_page_is_written_where_it_is_told_and_refused_in_words(tmp_path: Path) -> None:
    run = _run("bouncing_ball")
    path = tmp_path / "new" / "run.html"
    assert run.to_html(path, title="t") == path
    assert path.read_text(encoding="utf-8") == page(run, "t", 4000)
    with pytest.raises(ns.InvalidInput, match="most_knots"):
        run.to_html(path, most_knots=1)
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match=r"file/x\.html could not be written"):
        run.to_html(tmp_path / "file" / "x.html")


def test_a_notebook_gets_a_frame() -> None:
    text = _run("bouncing_ball")._repr_html_()
    assert text.startswith('<iframe srcdoc="')
    assert text.count("<iframe") == 1
    assert 'sandbox="allow-scripts"' in text


@pytest.mark.parametrize("found", [True, False])
def test_view_opens_the_page(found: bool, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    """Where there is no browser it says which file to open."""
    opened: list[str] = []

    def opens(address: str) -> bool:
        opened.append(address)
        return found

    monkeypatch.setattr("webbrowser.open", opens)
    path = _run("bouncing_ball").view()
    assert opened == [path.as_uri()]
    said = f"no browser was found; open this file: {path}" in capsys.readouterr().err
    assert said is not found
    assert "nonsmooth-view/1" in path.read_text(encoding="utf-8")
