"""Each scalar of the engine belongs to the lowest layer that works with it."""

from __future__ import annotations

import re
from pathlib import Path

import nonsmooth
from nonsmooth.engine.memory.tables import ARRAYS_OF

ENGINE = Path(nonsmooth.__file__).parent / "engine"
LOWER = {
    "numerics": (),
    "bodies": ("numerics",),
    "pairs": ("numerics", "bodies"),
    "delassus": ("numerics", "bodies", "pairs"),
    "contact": ("numerics", "bodies", "pairs", "delassus"),
    "impact": ("numerics", "bodies", "pairs", "delassus", "contact"),
    "flow": ("numerics", "bodies", "pairs", "delassus", "contact"),
    "events": ("numerics", "bodies", "pairs", "delassus", "contact", "impact", "flow"),
}


def test_no_layer_works_with_scalars_of_one_above_it() -> None:
    """So that an engine without the layers above has all that it needs."""
    used = {
        layer: {name for path in (ENGINE / layer).rglob("*.py") for name in re.findall(r"\bS\.(\w+)", path.read_text())}
        for layer in LOWER
    }
    assert {"t", "y"} <= used["bodies"]
    owner = {name: layer for layer, arrays in ARRAYS_OF.items() for name in arrays.scalars}
    wrong = [(name, layer) for name, above in owner.items() for layer in LOWER[above] if name in used[layer]]
    assert wrong == []
