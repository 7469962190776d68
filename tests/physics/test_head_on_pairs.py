"""Bodies that meet head on at rims, edges or parts that end at the same place: only the pair knows what parts them."""

from __future__ import annotations

import pytest

from tests.benchmarks.head_on.pairs import PAIRS
from tests.physics.head_on import FINE, central_of, drawn_of, wrong
from tests.physics.test_head_on import NAMES as OTHERS

NAMES = [name for name in PAIRS if name not in (*OTHERS, "hollow mesh", "cylinder, longer")]
_INEXACT = ("cylinder without feet",)
EXACT = [name for name in NAMES if PAIRS[name].central and name not in _INEXACT]
"""Pairs whose speeds are as exact as the tolerances, in line and turned by any angle."""


@pytest.mark.fast_cases(5)
@pytest.mark.parametrize("name", NAMES)
def test_pairs_collide_and_never_overlap(name: str) -> None:
    """Shifted by 0 to 5 mm, turned by 0 to a quarter turn, at 0.1 to 10 m/s."""
    assert wrong(drawn_of(name)) == []


@pytest.mark.fast_cases(3)
@pytest.mark.parametrize("name", EXACT)
def test_speeds_are_as_exact_as_the_integration_of_the_impact(name: str) -> None:
    """After a central impact the second body has v m1 (1 + e) / (m1 + m2), to 1e-9."""
    assert wrong(central_of(name), engine=FINE, accuracy=1e-9) == []
