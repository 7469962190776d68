"""A search for a closing gap, or for two bodies that meet, that is cut short: shorter steps show the same."""

from __future__ import annotations

import os
import subprocess
import sys

import numpy as np
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
solution = ns.simulate(system, 0.13)
print(solution.counters.steps, *solution.events.time, *solution.q_end)
"""
OTHERS = {"meeting": "BoxBody(0.05, 0.05, 0.05)", "gap_search": "Plate()"}
"""Body that the box meets, by the module of the search. Two convex shapes have one guard, a plane and a box many."""


def _ended(search: str, most: int) -> tuple[float, ...]:
    """Steps, times of events and end of a run with so many evaluations; constants of plain Python can be changed."""
    program = PROGRAM.format(search=search, most=most, other=OTHERS[search])
    environment = os.environ | {"NONSMOOTH_PLAIN": "1"}
    ran = subprocess.run([sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=True)
    return tuple(map(float, ran.stdout.split()))


@pytest.mark.slow
@pytest.mark.parametrize("search", OTHERS)
def test_shorter_steps_decide(search: str) -> None:
    """A run whose searches are cut short takes more steps, and has the same events."""
    few, many = _ended(search, 0), _ended(search, 1000)
    assert few[0] > many[0]
    np.testing.assert_allclose(few[1:], many[1:], rtol=0, atol=1e-9)
