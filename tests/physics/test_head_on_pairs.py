"""Bodies that meet head on at rims, edges or parts that end at the same place: only the pair knows what parts them."""

from __future__ import annotations

import pytest

from tests.benchmarks.head_on.meeting import Meeting
from tests.benchmarks.head_on.pairs import PAIRS
from tests.physics.head_on import FINE, central_of, drawn_of, wrong
from tests.physics.test_head_on import NAMES as OTHERS

NAMES = [name for name in PAIRS if name not in (*OTHERS, "hollow mesh")]
WORLDS = (1.0, 0.0, 0.0, 0.0), (0.8, 0.0, 0.36, 0.48), (0.1, -0.7, 0.5, 0.5)
"""Orientations of both bodies."""
EXACT = [name for name in NAMES if PAIRS[name].central]
"""Pairs whose speeds are as exact as the tolerances, in line and turned by any angle."""


@pytest.mark.fast_cases(5)
@pytest.mark.parametrize("name", NAMES)
def test_pairs_collide_and_never_overlap(name: str) -> None:
    """Shifted by 0 to 5 mm, turned by 0 to a quarter turn, at 0.1 to 10 m/s."""
    assert wrong(drawn_of(name)) == []


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("shift", [(0.0, 0.0), (1e-12, 0.0), (1e-9, 1e-9), (1e-6, 1e-6), (5e-3, 3e-3)])
def test_discs_in_almost_one_plane_meet_or_pass_each_other(axis: int, shift: tuple[float, float]) -> None:
    """The planes of the discs are 0 to 5 mm apart and turned by 0 to 1e-6 rad, in three orientations of both."""
    rows = [Meeting("disc", axis, shift, turn, world=world) for turn in (0.0, 1e-9, 1e-6) for world in WORLDS]
    assert wrong(rows) == []


@pytest.mark.parametrize("name", ["capsule", "coin", "cylinder", "rounded cylinder"])
@pytest.mark.parametrize("turn", [1e-6, 2e-6, 5e-6, 1e-5, 1e-2])
def test_sides_that_are_nearly_parallel_meet(name: str, turn: float) -> None:
    """The bodies are in line or shifted by 1 mm. Parallel sides touch along their length, other sides at a point."""
    rows = [Meeting(name, 0, (shift, 0.0), turn, world=world) for shift in (0.0, 1e-3) for world in WORLDS]
    assert wrong(rows) == []


@pytest.mark.parametrize("shift", [1e-9, 1e-6, 1e-3])
def test_a_corner_does_not_go_on_to_the_next_face(shift: float) -> None:
    """Three boxes of either body meet with faces whose borders lie in line: a corner leaves its face at the border."""
    rows = [
        Meeting("U", axis, (shift, 0.0), 0.0, speed, world)
        for axis in (0, 2)
        for speed in (0.1, 1.0)
        for world in WORLDS
    ]
    assert wrong(rows) == []


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("name", EXACT)
def test_speeds_are_as_exact_as_the_integration_of_the_impact(name: str) -> None:
    """After a central impact the second body has v m1 (1 + e) / (m1 + m2), to 1e-9."""
    assert wrong(central_of(name), engine=FINE, accuracy=1e-9) == []
