"""Flush faces that touch when they start: one contact a corner of their area; and parts that end at one place."""

from __future__ import annotations

import pytest

from tests.benchmarks.head_on.meeting import Meeting
from tests.benchmarks.head_on.pairs import PAIRS
from tests.physics.head_on import wrong
from tests.physics.test_touching_starts import FLAT, PUSHED, WIDER
from tests.physics.touching import axes_of, stacked

_SHIFTS = ((0.0, 0.0), (1e-9, 1e-9), (1e-6, 0.0), (1e-3, 0.0))
STACKS: dict[tuple[str, tuple[float, float]], int] = {
    **{(name, shift): 4 for name in FLAT for shift in _SHIFTS},
    **{(name, (0.0, 0.0)): 4 for name in WIDER},
    ("prism of 6", (0.0, 0.0)): 6,
    ("prism of 8", (0.0, 0.0)): 8,
}
"""Pair and shift [m] of the upper body, and the corners of the area in which the faces meet."""


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize(("stack", "corners"), STACKS.items(), ids=str)
def test_a_flush_body_has_one_contact_a_corner(stack: tuple[str, tuple[float, float]], corners: int) -> None:
    name, shift = stack
    found = stacked(name, 2, 0.0, shift)
    assert found.forces == pytest.approx((1.0, 1.0), abs=1e-9)
    assert found.points == corners


@pytest.mark.slow
@pytest.mark.parametrize("name", ["hollow box", "compound", "cylinder without feet"])
@pytest.mark.parametrize("shift", [(0.0, 0.0), (1e-6, 0.0), (1e-3, 1e-3)], ids=str)
def test_a_body_of_parts_on_an_equal_one_is_carried(name: str, shift: tuple[float, float]) -> None:
    found = stacked(name, 2, 0.0, shift)
    assert found.off < 1e-9
    assert found.forces == pytest.approx((1.0, 1.0), abs=1e-9)


@pytest.mark.fast_cases(2)
@pytest.mark.parametrize("name", [name for name in PAIRS if name not in PUSHED])
def test_a_body_that_is_pushed_collides_at_once(name: str) -> None:
    """With the speeds of a collision in flight."""
    rows = [Meeting(name, axis, turn=turn, distance=0.0) for axis in axes_of(name) for turn in (0.0, 1e-6, 0.3)]
    assert wrong(rows) == []
