"""Descriptions of arrays, in the form of xarray and of the CF conventions."""

from __future__ import annotations


def described(what: str, unit: str = "") -> dict[str, str]:
    """Attributes of an array. ``unit`` is empty if each column has its own unit, or if the unit depends on a law."""
    return {"units": unit, "long_name": what} if unit else {"long_name": what}
