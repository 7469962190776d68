"""Bodies that touch when they start: they stay as they are, collide if they are pushed, and carry each other."""

from __future__ import annotations

import pytest

from tests.benchmarks.head_on.meeting import Meeting
from tests.benchmarks.head_on.pairs import PAIRS
from tests.physics.head_on import wrong
from tests.physics.touching import axes_of, moved, stacked

PUSHED = [name for name in PAIRS if name not in ("U", "L")]
"""Pairs that collide at the start as in flight."""
STILL = list(PAIRS)
"""Pairs that stay as they are, in touch along any axis."""
FLAT = ("cube", "brick", "hull", "mesh", "brick, hull")
WIDER = ("cube, wider", "cube, wider twice", "cube, half as wide")
STACKS: dict[tuple[str, float, tuple[float, float]], int] = {
    **{(name, 0.0, (1e-3, 1e-3)): 4 for name in (*FLAT, *WIDER)},
    **{(name, 0.3, (0.0, 0.0)): 8 for name in FLAT},
    **{(name, 0.0, shift): 4 for name in WIDER for shift in ((1e-6, 0.0), (1e-3, 0.0))},
    ("prism of 6", 0.3, (0.0, 0.0)): 12,
    ("prism of 8", 0.3, (0.0, 0.0)): 16,
    ("cube, half as wide", 0.3, (0.0, 0.0)): 6,
}
"""Pair, turn [rad] and shift [m] of the upper body, and the corners of the area in which the faces meet."""


@pytest.mark.fast_cases(5)
@pytest.mark.parametrize("name", STILL)
def test_bodies_that_move_alike_stay_as_they_are(name: str) -> None:
    """At rest, and with one velocity."""
    cases = [(axis, turn, speed) for axis in axes_of(name) for turn in (0.0, 1e-6, 0.3) for speed in (0.0, 1.0)]
    assert {case: off for case in cases if (off := moved(name, *case)) > 1e-12} == {}


@pytest.mark.fast_cases(5)
@pytest.mark.parametrize("name", PUSHED)
def test_a_body_that_is_pushed_collides_at_once(name: str) -> None:
    """With the speeds of a collision in flight."""
    rows = [Meeting(name, axis, turn=turn, distance=0.0) for axis in axes_of(name) for turn in (0.0, 1e-6, 0.3)]
    assert wrong(rows) == []


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize(("stack", "corners"), STACKS.items(), ids=str)
def test_a_body_on_another_one_is_carried(stack: tuple[str, float, tuple[float, float]], corners: int) -> None:
    """By as many contacts as the area of contact has corners, whose forces sum up to the weight."""
    name, turn, shift = stack
    found = stacked(name, 2, turn, shift)
    assert found.off < 1e-9
    assert found.forces == pytest.approx((1.0, 1.0), abs=1e-9)
    assert found.points == corners
