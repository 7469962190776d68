"""Which properties of a dummy do not hold."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from nonsmooth.testing import NotChecked, Property, PropertyFailed, inputs

MOST = 4
"""How many properties a single fault may break, the one made for it included."""


def failures(properties: Sequence[Property], *, here: bool = False) -> dict[str, PropertyFailed]:
    """Return the failures by name of the property; checked in this process if ``here``."""
    found = {}
    for prop in properties:
        try:
            (prop.check if here else prop)()
        except NotChecked:
            continue
        except PropertyFailed as failure:
            found[prop.name] = failure
    return found


def assert_caught(properties: Sequence[Property], name: str) -> None:
    """Assert that a property catches the fault and few others do; how small its input gets is another question."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(inputs, "MOST_TRIALS", 0)
        # a function that does not come back must not run in this process
        found = failures(properties, here=name != "time budget")
    assert name in found, f"not caught by {name!r}, but by {sorted(found)}"
    assert len(found) <= MOST, sorted(found)
