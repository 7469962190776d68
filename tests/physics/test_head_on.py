"""Bodies that meet head on collide when and as the closed form says, and are never inside of each other."""

from __future__ import annotations

import pytest

from tests.physics.head_on import FINE, central_of, drawn_of, wrong

NAMES = (
    *("ball", "cube", "brick", "flat brick", "rounded brick", "hull", "mesh"),
    *("rounded disc", "capsule", "ellipsoid", "superellipsoid", "support", "L of a mesh"),
    *("cube, U", "cube, wider", "cube, wider twice", "cube, half as wide", "brick, hull", "brick, mesh"),
    *("cube, prism of 6", "box, cylinder", "cylinder, cone", "cube, rounded cube", "cube, capsule"),
    *("cube, disc", "cylinder, disc"),
)
"""Pairs whose features at the collision are those of faces, or of smooth surfaces."""
EXACT = [name for name in NAMES if name != "rounded brick"]
"""Pairs whose speeds and times are as exact as the tolerances, in line and turned by any angle."""


@pytest.mark.parametrize("name", ["cube", "brick, hull", "rounded brick", "capsule", "ellipsoid"])
def test_some_pairs_collide_and_never_overlap(name: str) -> None:
    """Shifted by 0 to 5 mm, turned by 0 to a quarter turn, at 0.1 to 10 m/s."""
    assert wrong(drawn_of(name)[:6]) == []


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_pairs_collide_and_never_overlap(name: str) -> None:
    """Shifted by 0 to 5 mm, turned by 0 to a quarter turn, at 0.1 to 10 m/s."""
    assert wrong(drawn_of(name)) == []


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("name", EXACT)
def test_speeds_are_as_exact_as_the_integration_of_the_impact(name: str) -> None:
    """After a central impact the second body has v m1 (1 + e) / (m1 + m2), to 1e-9."""
    assert wrong(central_of(name), engine=FINE, accuracy=1e-9) == []
