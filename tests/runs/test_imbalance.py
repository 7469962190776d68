"""When an energy account went out of balance, and where."""

from __future__ import annotations

import re

import nonsmooth as ns
from bodies import Ball, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from tests.testing.engine_dummies import Dummy

_WORK = 0.01
"""Booked although nobody does it [J]."""


def _book(memory: Memory, call: int) -> None:
    if 0.25 < memory[owners.Island.time] < 0.3:
        memory[owners.Totals.driven_work] += _WORK


def _bouncing(engine: ns.EventDriven | Dummy) -> ns.Solution:
    plate, near, far = Plate(), Ball(0.02), Ball(0.02)
    system = ns.System([plate, near, far], 9.81)
    for ball in (near, far):
        system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5))
    system.exclude(near, far)
    system.place(near, position=(0.0, 0.0, 0.1))
    system.place(far, position=(1.0, 0.0, 3.0))
    # a condition lets the engine pause at each step and event
    return ns.assemble(system, engine).run(0.6, sample_interval=1e-3, until=lambda run: False)


def test_the_span_and_the_bodies_are_named() -> None:
    """The other ball is far from the plate."""
    run = _bouncing(Dummy(_book))
    assert run.status == "suspect"
    assert repr(run).endswith("; see the page 'Stuck?' of the documentation)")
    found = re.search(r"Most of it came about from t = (\S+) s to (\S+) s, in contacts of 'ball 1'\. ", run.message)
    assert found is not None
    begin, end = map(float, found.groups())
    assert 0.24 < begin < end < 0.31


def test_an_account_that_closes_has_no_span_worth_naming() -> None:
    run = _bouncing(ns.EventDriven())
    assert run.status == "done"
    assert "came about" not in run.message
