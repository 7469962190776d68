"""Describe arrays for xarray by attributes of the CF conventions: a name in words, and the unit."""

from __future__ import annotations


def described(what: str, unit: str = "") -> dict[str, str]:
    """Attributes of an array. ``unit`` is empty if each column has its own unit, or if the unit depends on a law."""
    return {"units": unit, "long_name": what} if unit else {"long_name": what}
