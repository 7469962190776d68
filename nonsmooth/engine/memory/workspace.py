"""The workspace: all numbers of one trajectory, by owner. Kernels take it as their first argument, ``ws``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, get_args, get_type_hints

from nonsmooth.engine.memory.declare import Part, Record
from nonsmooth.engine.memory.owners.active_contact import ActiveContact, Unknown
from nonsmooth.engine.memory.owners.bodies import Articulation, Body, Joint, Load
from nonsmooth.engine.memory.owners.contact import Contact, DeclaredContact
from nonsmooth.engine.memory.owners.event import Event
from nonsmooth.engine.memory.owners.guards import Guard, ImpactGuard, OwnGuard
from nonsmooth.engine.memory.owners.impact import Impact
from nonsmooth.engine.memory.owners.island import Island, Step
from nonsmooth.engine.memory.owners.model import Coefficients, Model, Options, Tolerance
from nonsmooth.engine.memory.owners.neighbours import Carrier, HalfSpace, Pair, Search, Sphere
from nonsmooth.engine.memory.owners.problem import Problem
from nonsmooth.engine.memory.owners.run import Output, Request, Run, Totals


class Workspace:
    """All numbers of one trajectory, by owner."""

    model: Model
    options: Options
    tolerance: Tolerance
    coefficients: Coefficients
    request: Request
    totals: Totals
    run: Run
    output: Output
    island: Island
    step: Step
    event: Event
    impact: Impact
    problem: Problem

    bodies: Sequence[Body]
    articulations: Sequence[Articulation]
    joints: Sequence[Joint]
    loads: Sequence[Load]
    contacts: Sequence[Contact]
    declared_contacts: Sequence[DeclaredContact]
    actives: Sequence[ActiveContact]
    unknowns: Sequence[Unknown]
    guards: Sequence[Guard]
    own_guards: Sequence[OwnGuard]
    impact_guards: Sequence[ImpactGuard]
    spheres: Sequence[Sphere]
    half_spaces: Sequence[HalfSpace]
    searches: Sequence[Search]
    pairs: Sequence[Pair]
    carriers: Sequence[Carrier]

    floats: Any
    """All floats: blocks that plug-ins write are found there by their place."""
    integers: Any
    """All integers."""


def _owners() -> tuple[dict[str, type[Part]], dict[str, type[Record]]]:
    parts, records = dict[str, type[Part]](), dict[str, type[Record]]()
    for name, hint in get_type_hints(Workspace).items():
        if get_args(hint):
            records[name] = get_args(hint)[0]
        elif isinstance(hint, type) and issubclass(hint, Part):
            parts[name] = hint
    return parts, records


_parts, _records = _owners()
PARTS: Mapping[str, type[Part]] = _parts
"""Owners of which there is one, by their names in the workspace."""
RECORDS: Mapping[str, type[Record]] = _records
"""Owners of which there are many, by their names in the workspace."""
