"""Histories by name, for all variables of the table: shapes, labels, units, choices of parts, and messages."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, BallJoint, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.histories.contacts import ClosedContacts, NearContacts
from nonsmooth.histories.variables import VARIABLES, Variable, variables

_OVER_TIME = [name for name, row in VARIABLES.items() if row.over == "time"]
_OVER_IMPULSES = [name for name, row in VARIABLES.items() if row.over == "impulse"]
_N = {"coordinate": 14, "velocity": 12, "law_state": 0, "contact": 1, "joint": 1, "frame": 3}
_N |= {"axis": 3, "column": 3, "side": 2}


@pytest.fixture(scope="module")
def run() -> ns.Solution:
    """A ball that slides on a plate until it rolls, and another one that swings from a joint."""
    plate, ball, bob = Plate(), Ball(0.02), Ball(0.01)
    system = ns.System([plate, ball, bob])
    system.name(bob, "bob")
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.2), impact=EnergeticImpact(0.5))
    system.joint(BallJoint(first=(0.0, 0.0, 0.3), second=(-0.1, 0.0, 0.0)), plate, bob, name="pivot")
    system.place(ball, position=(0.0, 1.0, 0.02), velocity=(1.0, 0.0, 0.0))
    system.place(bob, position=(0.1, 0.0, 0.3))
    return ns.simulate(system, 0.5, sample_interval=0.01)


@pytest.mark.parametrize("name", _OVER_TIME)
def test_a_variable_has_the_shape_labels_and_unit_of_its_row(run: ns.Solution, name: str) -> None:
    """At many times and at a single one, in memory and as a dataset."""
    row, times = VARIABLES[name], np.array([0.3, 0.0, 0.123])
    history, one = run.history(name, times=times), run.history(name, times=0.123)
    assert history[name].shape == (3, *(_N[axis] for axis in row.axes))
    np.testing.assert_array_equal(one[name], history[name][2])
    assert history.axes[name] == ("time", *row.axes)
    assert history.units[name] == row.unit
    assert all(len(history.labels[axis]) == _N[axis] for axis in row.axes if axis != "law_state")
    data = history.to_xarray()[name]
    np.testing.assert_array_equal(data, history[name])
    assert (data.dims, data.attrs.get("units", "")) == (("time", *row.axes), row.unit)


def test_variables_of_one_reading_are_the_same_alone_and_together(run: ns.Solution) -> None:
    """To the last bit, at times between samples, because each reading makes its own pass over the run."""
    times = np.random.default_rng(2).uniform(0.0, 0.5, 20)
    together = run.history(*_OVER_TIME, times=times)
    for name in _OVER_TIME:
        np.testing.assert_array_equal(run.history(name, times=times)[name], together[name])


def test_impulses_are_those_of_the_events(run: ns.Solution) -> None:
    history, events = run.history(*_OVER_IMPULSES), run.events
    np.testing.assert_array_equal(history["impulse_contact"], events.listed)
    np.testing.assert_array_equal(history["normal_impulse"], events.listed_impulse[:, 0])
    np.testing.assert_array_equal(history.time, events.time[history["impulse_event"]])
    size = np.linalg.norm(events.listed_impulse[:, 1:], axis=1)
    np.testing.assert_allclose(np.linalg.norm(history["friction_impulse"], axis=1), size, rtol=1e-12)
    assert history.to_xarray()["normal_impulse"].dims == ("impulse",)


def test_a_sliding_ball_has_known_histories(run: ns.Solution) -> None:
    """Its speed falls by mu g, and it rolls at 5/7 of the speed at the start."""
    times = np.array([0.05, 0.1])
    history = run.history("velocity", "slip_speed", "mode", "mode_word", times=times, of="ball")
    np.testing.assert_allclose(history["velocity"][:, 0, 0], 1.0 - 0.2 * 9.81 * times, rtol=1e-9)
    np.testing.assert_allclose(history["slip_speed"][:, 0], 1.0 - 3.5 * 0.2 * 9.81 * times, rtol=1e-8)
    assert history["mode_word"].tolist() == 2 * ["{1,0,1}"]
    rolls = run.history("velocity", "angular_velocity", "mode", times=0.4, of=[run.system.bodies[1]])
    np.testing.assert_allclose(rolls["velocity"][0], [5.0 / 7.0, 0.0, 0.0], rtol=0, atol=1e-9)
    np.testing.assert_allclose(rolls["angular_velocity"][0], [0.0, 5.0 / 7.0 / 0.02, 0.0], rtol=0, atol=1e-7)
    assert rolls["mode"].tolist() == [1]


def test_a_variable_of_your_own_needs_a_row_and_no_table(run: ns.Solution) -> None:
    """The power of friction sums up to the loss to friction."""
    slip_power = Variable(
        "slip_power",
        "W",
        ("contact",),
        "power of friction",
        ClosedContacts.of,
        lambda c: c.spread(np.sum(c.friction_force * c.slip_velocity, axis=1), if_open=0.0),
    )
    times = np.linspace(0.0, 0.1, 101)
    history = run.history(slip_power, "friction_loss", times=times)
    lost = np.trapezoid(-history["slip_power"][:, 0], times)
    assert lost == pytest.approx(history["friction_loss"][-1] - history["friction_loss"][0], rel=1e-6)
    assert "slip_power  " in repr(history)


def test_parts_are_chosen_by_object_name_or_number(run: ns.Solution) -> None:
    _, ball, bob = run.system.bodies
    whole = run.history("q")
    for of in (bob, "bob", 2, [bob], ("bob",), np.array([2])):
        chosen = run.history("q", of=of)
        np.testing.assert_array_equal(chosen["q"], whole["q"][:, 7:])
        assert chosen.labels["coordinate"][:2] == ("bob x", "bob y")
    both = run.history("position", "gap", of=[ball, "plate - ball"])
    assert (both.labels["frame"], both.labels["contact"]) == (("ball",), ("plate - ball",))
    twice = run.history("normal_force", of=[0, 0])
    np.testing.assert_array_equal(twice["normal_force"][:, 0], twice["normal_force"][:, 1])
    assert run.history("joint_force", of="pivot").labels["joint"] == ("pivot",)
    assert run.history("normal_force", "position", of=[])["position"].shape == (51, 0, 3)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (
            lambda run: run.history("gapp"),
            r"Solution\.history: unknown variable .*Did you mean 'gap'.*variables\(\)\) lists",
        ),
        (lambda run: run.history(), "must be at least one.*Known: q, u"),
        (lambda run: run.history("gap", "normal_impulse"), "Ask for each kind in its own call"),
        (lambda run: run.history("normal_impulse", times=0.1), "times must be left out.*times of their events"),
        (
            lambda run: run.history(Variable("all", "m", (), "gaps", NearContacts.of, lambda near: near.gap)),
            r"values of the variable 'all' must have the axes time \(51\), but it is \(51, 1\)",
        ),
        (lambda run: run.history("gap", of="plat - ball"), "of: unknown contact .*Did you mean 'plate - ball'"),
        (lambda run: run.history("gap", of=1), "of: contact must be below 1, the number of contacts"),
        (lambda run: run.history("gap", "q", of=0), "contact or body were asked for, so a number is not clear"),
        (lambda run: run.history("loss", of="ball"), "of must be left out"),
        (lambda run: run.history("q", of=Ball(0.01)), "needs a body of this system"),
        (
            lambda run: run.history("q")["u"],
            r"Unknown variable of this history .*Known: q\. Name it in Solution",
        ),
        (lambda run: run.history("q", times=math.nan), "must be within the run"),
    ],
)
def test_a_wrong_request_names_the_remedy(run: ns.Solution, ask: Any, message: str) -> None:
    with pytest.raises(ns.InvalidInput, match=message):
        ask(run)


def test_a_history_prints_what_it_holds(run: ns.Solution) -> None:
    printed = repr(run.history("gap", "q", times=[0.0, 0.5])).splitlines()
    assert printed[0] == "History(2 times, 0 to 0.5 s)"
    assert printed[1].startswith("  gap  [m]  (time, contact)")
    assert printed[3] == "  contact: plate - ball"
    assert "and 8 more" in printed[4]
    assert repr(run.history("loss", times=[])).startswith("History(no times)")


def test_a_history_is_a_mapping_of_its_arrays(run: ns.Solution) -> None:
    history = run.history("q", "u")
    assert (list(history), len(history), "q" in history, "gap" in history) == (["q", "u"], 2, True, False)
    assert all(np.array_equal(history[name], array) for name, array in history.items())


def test_the_page_lists_all_variables() -> None:
    """As the table itself does, a line each."""
    page = (Path(__file__).parents[2] / "docs" / "pages" / "howto" / "over_time.md").read_text(encoding="utf-8")
    assert [line.split()[0] for line in variables().splitlines()] == list(VARIABLES)
    assert [name for name in VARIABLES if f"`{name}`" not in page] == []


def _own(name: str = "doubled_gap", axes: Any = ("contact",), reading: Any = NearContacts.of, **more: Any) -> Variable:
    return Variable(name, "m", axes, "a variable of the test", reading, more.get("values", lambda near: 2.0 * near.gap))


def test_a_variable_of_ones_own_stands_beside_others(run: ns.Solution) -> None:
    for own in (_own(), _own(values=lambda near: (2.0 * near.gap).tolist())):
        history = run.history("gap", own, times=[0.0, 0.5])
        np.testing.assert_array_equal(history["doubled_gap"], 2.0 * history["gap"])


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: ["gap", "gap"], "names must differ"),
        (lambda: [_own(), _own()], "names must differ"),
        (lambda: [_own("gap")], "must have a name of its own, but it is 'gap'"),
        (lambda: [_own(values=lambda near: near.gap[:, 0])], r"must have the axes time \(2\), contact \(1\).*spread"),
        (lambda: [_own(values=lambda near: near.gap[:1])], r"must have the axes time \(2\), contact \(1\).*\(1, 1\)"),
        (lambda: [_own(axes=("axis",))], r"must have the axes time \(2\), axis \(3\)"),
        (lambda: [_own(axes="contact")], "axes must be of the kind tuple"),
        (lambda: [_own(reading=NearContacts)], "reading must be a function of a request.*Take `of`"),
    ],
)
def test_a_variable_that_does_not_fit_is_refused(run: ns.Solution, ask: Callable[[], list[Any]], message: str) -> None:
    with pytest.raises(ns.InvalidInput, match=message):
        run.history(*ask(), times=[0.0, 0.5])
