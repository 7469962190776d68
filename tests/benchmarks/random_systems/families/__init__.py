"""Families of random systems: a module each, whose ``draw`` makes a system of random numbers.

In the flush families faces meet faces.  Their bodies are equal mostly, their axes parallel but for an angle of 0 or
1e-9 to 1e-2 rad, and their sides in line but for a shift of 0 or 1e-12 to 1e-3 of a size.
"""

from __future__ import annotations

from collections.abc import Callable

from tests.benchmarks.random_systems.case import Case
from tests.benchmarks.random_systems.families import at_rest, fall, head_on, heap, slide, stack, tumbling
from tests.benchmarks.random_systems.solids import Random

TUMBLING: Callable[[Random], Case] = tumbling.draw
FLUSH: dict[str, tuple[float, Callable[[Random], Case]]] = {
    "head_on": (0.25, head_on.draw),
    "slide": (0.2, slide.draw),
    "fall": (0.2, fall.draw),
    "at_rest": (0.15, at_rest.draw),
    "stack": (0.12, stack.draw),
    "heap": (0.08, heap.draw),
}
"""Part of the flush systems that is of each family, and what draws one."""
