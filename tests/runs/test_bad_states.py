"""A state that is none of the model is refused by name, with the rule, the value and what to do."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball


@pytest.fixture
def model(build: Any) -> ns.Model:
    system = build.over(Ball(0.01))
    system.place(system.bodies[1], position=(0.0, 0.0, 0.01), velocity=(0.5, 0.0, 0.0))
    return ns.assemble(system)


def _refused(model: ns.Model, *words: str, t_end: float = 1.0, **changed: Any) -> None:
    state = dataclasses.replace(model.run(0.01).state, **changed)
    with pytest.raises(ns.InvalidInput) as caught:
        model.run(t_end, start=state)
    for word in words:
        assert word in str(caught.value)
    assert model.run(0.01).status == "done"


def test_other_numbers_of_anything(model: ns.Model) -> None:
    _refused(model, "State.q", "shape (7,)", "(14,)", "solution.state", q=np.zeros(14))
    _refused(model, "State.u", "shape (6,)", u=np.zeros(7))
    _refused(model, "State.modes", "shape (1,)", modes=np.zeros(2, dtype=int))
    _refused(model, "State.law_states", "shape (0,)", law_states=np.zeros(1))


def test_numbers_that_are_none(model: ns.Model) -> None:
    _refused(model, "State.u", "finite", "nan", "entry 1", u=np.array([0.0, math.nan, 0.0, 0.0, 0.0, 0.0]))
    _refused(model, "State.time", "finite", "inf", time=math.inf)


def test_a_quaternion_off_unit_length(model: ns.Model) -> None:
    q = np.array([0.0, 0.0, 0.01, 1.0, 0.1, 0.0, 0.0])
    _refused(model, "State.q of 'ball': the quaternion q[3:7]", "unit length", "1.00498", "Divide it", q=q)


def test_a_mode_that_is_none_or_does_not_hold(model: ns.Model) -> None:
    _refused(model, "State.modes", "0 (open), 1 (stick) or 2 (slide)", "[3]", modes=np.array([3]))
    q = np.array([0.0, 0.0, 0.02, 1.0, 0.0, 0.0, 0.0])
    _refused(model, "State.modes[0]", "must be 0, open", "gap is 0.01 m", "State.at", q=q)


def test_bodies_in_one_another(model: ns.Model) -> None:
    q = np.array([0.0, 0.0, 0.005, 1.0, 0.0, 0.0, 0.0])
    _refused(model, "must not overlap", "-0.005", q=q, modes=np.zeros(1, dtype=int))


def test_a_time_beyond_the_end(model: ns.Model) -> None:
    _refused(model, "run: t_end", "after the start at 2 s", "1.0", time=2.0)
    _refused(model, "run: t_end", "after the start at 0.01 s", t_end=0.005)
