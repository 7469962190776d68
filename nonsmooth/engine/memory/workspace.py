"""The workspace: all numbers of one trajectory, by owner. Kernels take it as their first argument, ``ws``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, get_args, get_type_hints

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import Record, Singleton


class Workspace:
    """All numbers of one trajectory, by owner."""

    model: owners.ModelNumbers
    options: owners.Options
    tolerance: owners.Tolerance
    coefficients: owners.Coefficients
    request: owners.Request
    totals: owners.Totals
    run: owners.Run
    output: owners.OutputNumbers
    island: owners.Island
    step: owners.Step
    event: owners.Event
    impact: owners.Impact
    problem: owners.Problem

    bodies: Sequence[owners.BodyRecord]
    articulations: Sequence[owners.Articulation]
    joints: Sequence[owners.JointRecord]
    loads: Sequence[owners.LoadRecord]
    contacts: Sequence[owners.ContactRecord]
    rows: Sequence[owners.RowRecord]
    kinds: Sequence[owners.KindRecord]
    histories: Sequence[owners.HistoryRecord]
    actives: Sequence[owners.ActiveContact]
    unknowns: Sequence[owners.Unknown]
    guards: Sequence[owners.GuardRecord]
    own_guards: Sequence[owners.OwnGuard]
    impact_guards: Sequence[owners.ImpactGuard]
    spheres: Sequence[owners.BoundingSphere]
    half_spaces: Sequence[owners.HalfSpaceRecord]
    searches: Sequence[owners.Search]
    pairs: Sequence[owners.Pair]
    carriers: Sequence[owners.Carrier]

    floats: Any
    """All floats, with the blocks that plug-ins write, which are found by their offsets."""
    integers: Any
    """All integers."""


def _owners() -> tuple[dict[str, type[Singleton]], dict[str, type[Record]]]:
    """Parts and records of the workspace by name, from its type hints."""
    parts, records = dict[str, type[Singleton]](), dict[str, type[Record]]()
    for name, hint in get_type_hints(Workspace).items():
        # records are hinted as sequences of their owner, parts by their owner, all floats and integers as Any
        if get_args(hint):
            records[name] = get_args(hint)[0]
        elif isinstance(hint, type) and issubclass(hint, Singleton):
            parts[name] = hint
    return parts, records


_parts, _records = _owners()
PARTS: Mapping[str, type[Singleton]] = _parts
"""Owners of which there is one, by their names in the workspace."""
RECORDS: Mapping[str, type[Record]] = _records
"""Owners of which there are many, by their names in the workspace."""
