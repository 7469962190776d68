"""A gap that is looked at without end ends the run by the name of its contact."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

PROGRAM = """
import nonsmooth as ns
from bodies import BoxBody
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.flow import gap_search

gap_search._MOST_EVALUATIONS = {most}
one, two = BoxBody(0.05, 0.05, 0.05), BoxBody(0.05, 0.05, 0.05)
system = ns.System([one, two], gravity=0.0)
system.contact(one, two, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5))
system.place(one, velocity=(1.0, 0.0, 0.0), angular_velocity=(3.0, 2.0, 1.0))
system.place(two, position=(0.2, 0.0, 0.0), orientation=ns.turned_about((0.0, 0.0, 1.0), 0.4))
try:
    print(ns.simulate(system, 0.12).status)
except ns.RunFailed as error:
    print(error)
"""


def _said(most: int) -> str:
    """Return what is said of a run with so many looks at most; as plain Python, whose constants can be changed."""
    words = [sys.executable, "-c", PROGRAM.format(most=most)]
    ran = subprocess.run(words, env=os.environ | {"NONSMOOTH_PLAIN": "1"}, capture_output=True, text=True, check=True)
    return ran.stdout


@pytest.mark.slow
def test_its_contact_and_its_step_are_named() -> None:
    """A run that needs no more looks is not affected."""
    said = _said(0)
    assert "whether a gap closes within a step is not decided" in said
    assert "The contact 'box 1 - box 2 (" in said
    assert "EventDriven(tolerance=...)" in said
    assert _said(1000) == "done\n"
