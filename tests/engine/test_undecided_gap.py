"""A search for the closing of a gap, or for the meeting of two bodies, that has no end: the run names the bodies."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

PROGRAM = """
import nonsmooth as ns
from bodies import BoxBody, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.flow import gap_search, meeting

{search}._MOST_EVALUATIONS = {most}
box, other = BoxBody(0.05, 0.05, 0.05), {other}
system = ns.System([box, other])
system.contact(box, other, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5))
system.place(box, position=(0.0, 0.0, 0.2), velocity=(0.0, 0.0, -1.0), angular_velocity=(3.0, 2.0, 1.0))
try:
    print(ns.simulate(system, 0.12).status)
except ns.RunFailed as error:
    print(f"RunFailed: {{error}}")
"""
OTHERS = {"meeting": "BoxBody(0.05, 0.05, 0.05)", "gap_search": "Plate()"}
"""Body that the box meets, by the module of the search. Two convex shapes have one guard, a plane and a box many."""
MESSAGES = {
    "meeting": (
        "whether bodies meet within a step is not decided after ten thousand evaluations",
        "The bodies 'box 1' and 'box 2' of the contact 'box 1 - box 2 (1)'",
        "EventDriven(largest_step=...)",
    ),
    "gap_search": (
        "whether a gap closes within a step is not decided after ten thousand evaluations",
        "The contact 'plate - box (",
        "EventDriven(tolerance=...)",
    ),
}


def message_of(search: str, most: int) -> str:
    """Message of a run with at most so many evaluations; it is plain Python, whose constants can be changed."""
    program = PROGRAM.format(search=search, most=most, other=OTHERS[search])
    environment = os.environ | {"NONSMOOTH_PLAIN": "1"}
    ran = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True)
    return ran.stdout


@pytest.mark.slow
@pytest.mark.parametrize("search", MESSAGES)
def test_bodies_and_step_are_named(search: str) -> None:
    """A run that needs fewer evaluations is not affected."""
    message = message_of(search, 0)
    assert all(part in message for part in MESSAGES[search])
    assert message_of(search, 1000) == "done\n"
