"""From a description to a system of this commit."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import nonsmooth as ns
from tests.benchmarks.described.components import component

_PLACES: dict[str, Callable[..., object]] = {"touching": ns.touching, "resting": ns.resting, "at_height": ns.at_height}
"""How a body is moved until it is near the others."""


def build(description: dict[str, Any]) -> ns.System:
    """Return the system of a description, every body placed."""
    bodies = component(description["bodies"])
    laws = contact_laws(description)
    system = ns.System(list(bodies), gravity=description["gravity"])
    if "contact_all" in description:
        system.contact_all(laws[description["contact_all"]])
    for one, other, number in description.get("contacts", []):
        row = laws[number]
        system.contact(bodies[one], bodies[other], normal=row.normal, friction=row.friction, impact=row.impact)
    for one, other, joint in description.get("joints", []):
        system.joint(component(joint), bodies[one], bodies[other])
    for number, how, arguments in _moves(description["starts"]):
        if how == "place":
            system.place(bodies[number], **arguments)
        else:
            _PLACES[how](system, bodies[number], **arguments)
    return system


def contact_laws(description: dict[str, Any]) -> list[ns.ContactLaws]:
    """Return the laws of a description, by their numbers."""
    return [ns.ContactLaws(**{role: component(law) for role, law in one.items()}) for one in description["laws"]]


def _moves(starts: list[dict[str, Any] | None]) -> Iterator[tuple[int, str, dict[str, Any]]]:
    """Yield every body as given, as a body is moved until it touches any of the others; then those that are moved."""
    rows = [(k, start["how"], _arguments(start)) for k, start in enumerate(starts) if start is not None]
    for k, _, arguments in rows:
        yield k, "place", {name: value for name, value in arguments.items() if name != "height"}
    for k, how, arguments in rows:
        if how != "place":
            yield k, how, arguments


def _arguments(start: dict[str, Any]) -> dict[str, Any]:
    return {name: component(value) for name, value in start.items() if name != "how"}
