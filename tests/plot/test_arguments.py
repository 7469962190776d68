"""Names that are none, and what is missing: each told with its remedy."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import pytest

import nonsmooth as ns
from bodies import Ball
from nonsmooth import plot
from nonsmooth.errors import MissingPackagesError

_WRONG: dict[str, tuple[Callable[[ns.Solution], Any], str]] = {
    "contact": (lambda run: plot.gaps(run, "plate - bal"), r"plot\.gaps: unknown contact 'plate - bal'.*Did you mean"),
    "number": (lambda run: plot.forces(run, [0, 1]), r"plot\.forces: contact must be below 1"),
    "none": (lambda run: plot.modes(run, []), r"plot\.modes: contacts must be some"),
    "body": (lambda run: plot.path(run, "bal"), r"plot\.path: unknown body 'bal'. Did you mean 'ball'"),
    "other body": (lambda run: plot.path(run, Ball(0.01)), r"plot\.path needs a body of this system"),
    "frame": (lambda run: plot.path(run, "ball", frame=1), r"plot\.path: frame must be below 1"),
    "plane": (lambda run: plot.path(run, "ball", plane="xx"), r"plot\.path: plane must be two of"),
    "coordinate": (lambda run: plot.phase_portrait(run, "ball Z"), r"coordinate .*'ball Z'.*Did you mean 'ball "),
    "part": (lambda run: plot.velocities(run, part="norm"), r"velocities: part must be 'normal' or 'slip'.*'norm'"),
    "time": (lambda run: plot.energies(run, times=[0.1, 7.0]), r"plot\.energies: times must be within the run.*7\.0"),
}


@pytest.mark.parametrize("name", _WRONG)
def test_what_is_wrong_is_named(bounces: ns.Solution, name: str) -> None:
    call, message = _WRONG[name]
    with pytest.raises(ns.InvalidInput, match=message):
        call(bounces)


def test_a_run_without_contacts_has_no_gaps() -> None:
    ball = Ball(0.01)
    solution = ns.simulate(ns.System([ball]), 0.1)
    with pytest.raises(ns.InvalidInput, match="Take a system and a run that have contacts"):
        plot.gaps(solution)


@pytest.mark.slow
def test_matplotlib_is_asked_for_when_it_is_needed(bounces: ns.Solution, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "matplotlib.pyplot", None)
    with pytest.raises(MissingPackagesError, match=r"nonsmooth\[full\]"):
        bounces.plot()
