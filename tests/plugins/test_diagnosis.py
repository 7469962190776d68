"""What a failed run says, and that it says so whatever goes wrong on the way."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plate
from laws import Frictionless, Unilateral
from nonsmooth.runs import diagnosis
from tests.plugins.failing_laws import Map


def without_value(n: int, delassus: Any, rates: Any, out: Any, friction: Any) -> None:
    """Return no impulses."""
    for i in range(3 * n):
        out[i] = math.nan


def _second_ball_lands() -> None:
    """Run two balls over a plate, of which the one declared last lands first, to its end."""
    plate, high, low = Plate(), Ball(0.01), Ball(0.02)
    system = ns.System([plate, high, low])
    for ball, height in ((high, 0.5), (low, 0.03)):
        system.contact(plate, ball, normal=Unilateral(), friction=Frictionless(), impact=Map(without_value))
        system.place(ball, position=(10.0 * height, 0.0, height))
    ns.simulate(system, 0.1)


def test_a_map_without_value_is_named_with_its_contact() -> None:
    """The contact that collided is not among the first of the list."""
    with pytest.raises(ns.RunFailed, match=r"Map: without_value .* \(1 in contact: contact 'plate - ball 2'\)"):
        _second_ball_lands()


@pytest.mark.parametrize("error", [IndexError("out of range"), SystemExit(), KeyboardInterrupt()], ids=repr)
def test_a_diagnosis_that_fails_keeps_the_solution(error: BaseException, monkeypatch: pytest.MonkeyPatch) -> None:
    """What was computed comes with the error, and the error says what looking for its cause came to."""

    def fails(*_: object) -> str:
        raise error

    monkeypatch.setattr(diagnosis, "_failing_map", fails)
    with pytest.raises(ns.RunFailed, match=type(error).__name__) as caught:
        _second_ball_lands()
    solution = caught.value.solution
    assert isinstance(solution, ns.Solution)
    assert 0.0 < solution.t_end < 0.1
    assert np.all(np.isfinite(solution.q_end))
