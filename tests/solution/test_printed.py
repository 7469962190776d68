"""What an interactive session prints of a run is short, however long the run; so is the help on a solution."""

from __future__ import annotations

import importlib.metadata
import pydoc
import re
from typing import Any

import pytest

import nonsmooth as ns
from bodies import Ball, Plate
from nonsmooth.solution.modes import transition_graph


@pytest.mark.slow
def test_what_is_printed_is_short(build: Any) -> None:
    """With what one looks for first."""
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    system.contact(plate, ball, **build.laws(0.5, 0.2))
    system.place(ball, position=(0.0, 0.0, 0.1))
    solution = ns.simulate(system, 0.5)
    events = len(solution.events)
    for thing, said in (
        (system, "System(bodies 2, contacts 1)"),
        (solution, "Solution(done at t = 0.5 s: the end time was reached; 2001 samples, "),
        (solution.events, f"Events({events}: {events - 2} impact, 1 start, 1 closing of an accumulation)"),
        (solution.state, "State(t = 0.5 s: 7 coordinates, 6 velocities, 1 of 1 contacts closed)"),
        (solution.track, "Track(2002 states, 0 to 0.5 s; "),
        (solution.recorded, "Recorded(2001 samples, "),
        (transition_graph(solution), "TransitionGraph("),
        (system.contacts[0], "Contact('plate - ball': plane-sphere; Unilateral, Coulomb, EnergeticImpact)"),
    ):
        assert repr(thing).startswith(said)
        assert len(repr(thing)) < 130
    assert repr(ns.System([plate])) == "System(bodies 1)"
    assert repr(ns.assemble(ns.System([plate]))) == "Model(System(bodies 1), EventDriven)"


def test_help_on_a_solution_fits_two_screens() -> None:
    """Without private names."""
    lines, is_public = 0, True
    for line in pydoc.plain(pydoc.render_doc(ns.Solution)).splitlines():
        if name := re.match(r" \|  (\w+)(\(| =|$)", line):
            is_public = not name[1].startswith("_")
        lines += is_public
    assert lines < 120


def test_the_version_is_that_of_the_package() -> None:
    """As pip tells it."""
    assert ns.__version__ == importlib.metadata.version("nonsmooth")
    assert not hasattr(ns, "__versions__")
