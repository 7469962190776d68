"""Dice: they end on a face, the books balance, the same throw is the same."""

from __future__ import annotations

from typing import Any

import pytest

import nonsmooth as ns
from nonsmooth.engine.native.kernel import PLAIN
from scenarios.dice_throw import DiceThrow


@pytest.mark.slow
@pytest.mark.parametrize("rounding", [0.0, 1e-3])
@pytest.mark.parametrize("throw", [2, 3, 7, 8])
def test_dice_come_to_rest_on_a_face(throw: int, rounding: float) -> None:
    dice = DiceThrow(throw=throw, rounding=rounding)
    solution = ns.simulate(dice.build(), dice.t_end, sample_interval=dice.sample_interval)
    assert dice.on_a_face(solution)
    criteria = dice.acceptance(solution)
    assert len(criteria) == 4
    assert all(one.fulfilled for one in criteria)
    assert all(1 <= eyes <= 6 for eyes in dice.eyes(solution))
    again = ns.simulate(dice.build(), dice.t_end, sample_interval=dice.sample_interval)
    assert again.q_end.tolist() == solution.q_end.tolist()


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="some minutes in plain mode")
@pytest.mark.parametrize("throw", [1, 4, 5, 6, 9, 10, 11, 12, 28, 31, 32, 39])
def test_every_throw_of_rounded_dice_ends(throw: int) -> None:
    """The first twelve, with those above, and some that need a certain thing.

    These are borders of features at which a force jumps below zero (28, 32), two contacts for one where one hands over
    to the other (31), and slips so slow that bringing others to rest turns them (39).
    """
    dice = DiceThrow(throw=throw)
    solution = ns.simulate(dice.build(), dice.t_end, sample_interval=dice.sample_interval)
    assert dice.on_a_face(solution)
    assert all(one.fulfilled for one in dice.acceptance(solution))


@pytest.mark.parametrize(("throw", "t_end"), [(14, 0.08), (171, 0.105)])
def test_edges_that_face_each_other_for_an_instant_are_not_passed(throw: int, t_end: float) -> None:
    """Nearly parallel edges of dice rounded by 3 mm close within 0.2 ms in which their nearest points run along them.

    Between two looks nothing is seen of that; behind it the gap of a vertex jumps to where the bodies overlap.
    """
    dice = DiceThrow(throw=throw, rounding=3e-3, t_end=t_end)
    solution = ns.simulate(dice.build(), dice.t_end, sample_interval=dice.sample_interval)
    assert solution.status == "done"
    assert solution.events.time[-1] > t_end - 5e-3


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="some minutes in plain mode")
@pytest.mark.parametrize(("throw", "t_end"), [(6, 1.0), (20, 1.0), (59, 1.0), (84, 0.14), (102, 1.0), (114, 1.0)])
def test_sharp_dice_slide_off_each_other(throw: int, t_end: float) -> None:
    """They need certain things.

    These are a vertex put past its end, one that comes in through a side, edges that cross for microseconds, an event
    whose correction would pass another one (84), and a faint guard.
    """
    dice = DiceThrow(throw=throw, rounding=0.0, t_end=t_end)
    solution = ns.simulate(dice.build(), dice.t_end, sample_interval=dice.sample_interval)
    assert solution.t_end == t_end
    assert all(one.fulfilled for one in dice.acceptance(solution))


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="some minutes in plain mode")
def test_guards_that_crowd_in_a_step_are_not_looked_for_one_by_one() -> None:
    """Looked at after every step throw 68 meets one in which hundreds fire, each before the one found last."""
    dice = DiceThrow(throw=68, rounding=1e-3, t_end=0.2)
    solution = ns.simulate(dice.build(), dice.t_end, sample_interval=dice.sample_interval, until=lambda _run: False)
    assert solution.t_end == dice.t_end
    assert solution.counters.gap_looks < 10_000


def test_half_a_die_is_refused() -> None:
    with pytest.raises(ns.InvalidInput, match="an integer"):
        DiceThrow(**dict[str, Any](number=1.5))
