"""What an interactive session prints of a run is a line, however long the run."""

from __future__ import annotations

import importlib.metadata
from typing import Any

import pytest

import nonsmooth as ns
from bodies import Ball, Plate


@pytest.mark.slow
def test_what_is_printed_is_short(build: Any) -> None:
    """With what one looks for first."""
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    system.contact(plate, ball, **build.laws(0.5, 0.2))
    system.place(ball, position=(0.0, 0.0, 0.1))
    solution = ns.simulate(system, 0.5)
    history = solution.distances(plate, ball)
    events = len(solution.events)
    for thing, said in (
        (system, "System(bodies 2, contacts 1)"),
        (solution, "Solution(done at t = 0.5 s: the end time was reached; 2001 samples, "),
        (solution.events, f"Events({events}: {events - 2} impact, 1 start, 1 closing of an accumulation)"),
        (solution.state, "State(t = 0.5 s: 7 coordinates, 6 velocities, 1 of 1 contacts closed)"),
        (history, "DistanceHistory(least gap "),
        (solution.at(), "States(2001 times, 0 to 0.5 s; 7 coordinates, 1 contacts)"),
        (solution.poses(ball, 0.1), "Poses(t = 0.1 s; 1 frames)"),
        (solution.energies([]), "Energies(no times; start "),
        (solution.joint_forces(), "JointForces(2001 times, 0 to 0.5 s; 0 joints)"),
        (solution.contact_forces(0.5), "ContactForces(t = 0.5 s; 1 contacts, 1 entries)"),
        (solution.track, "Track(2002 states, 0 to 0.5 s; "),
        (solution.recorded, "Recorded(2001 samples, "),
        (solution.transition_graph(), "TransitionGraph("),
        (system.contacts[0], "Contact('plate - ball': PlaneSphere; Unilateral, Coulomb, EnergeticImpact)"),
        (solution.contact_forces().history(0), "ContactHistory(2001 times, 0 to 0.5 s; largest normal force "),
    ):
        assert repr(thing).startswith(said)
        assert len(repr(thing)) < 130
    assert repr(history).endswith("told by exact 2001)")
    assert repr(ns.System([plate])) == "System(bodies 1)"
    assert repr(ns.assemble(ns.System([plate]))) == "Model(System(bodies 1), EventDriven)"


def test_the_version_is_that_of_the_package() -> None:
    """As pip tells it."""
    assert ns.__version__ == importlib.metadata.version("nonsmooth")
    assert not hasattr(ns, "__versions__")
