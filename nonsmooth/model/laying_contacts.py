"""Contacts and their laws, laid into the engine's memory."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from operator import attrgetter, itemgetter
from typing import Any, TypeAlias

import numpy as np

from nonsmooth.binding.bounds import try_out
from nonsmooth.binding.compile import bind, parameter_names, parameter_place, vector_place
from nonsmooth.engine.memory.blocks import FORCE_AND_MOMENT, FRAME, PAIR
from nonsmooth.engine.memory.layout import (
    CATALOGUE,
    CATALOGUE_FLOATS,
    CONTACT_TIME,
    DIRECTION,
    LEVERS,
    MEAN_ASKED,
    REACH,
    REVOLUTION,
    SIZE,
)
from nonsmooth.engine.memory.memory import Heap, Memory, output_block
from nonsmooth.engine.memory.modes import OPEN
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import (
    AnisotropicFrictionLaw,
    CompliantNormalLaw,
    FrictionLaw,
    ImpactMap,
    ImpactProcess,
    StatefulFrictionLaw,
    TangentialLaw,
    TractionLaw,
)
from nonsmooth.model.contact_table import ContactTable
from nonsmooth.model.laying import Places
from nonsmooth.parameters import Table, Value
from nonsmooth.system.contact import Contact

COLUMN = {name: number for number, name in enumerate(CATALOGUE)}
"""Where the entries of the catalogue stand in its rows."""
_Function: TypeAlias = tuple[str, Callable[..., Any], str, Mapping[str, Value]]
"""Name in the catalogue, function, form, parameters that it may ask for."""
Kinds: TypeAlias = Sequence[list[int]]
"""The numbers of the contacts of each kind."""


@dataclass
class Kind:
    """What contacts of the same geometry and laws have in common.

    Attributes
    ----------
    fields : dict
        Entries of the catalogue.
    offsets : dict
        Those that lead to a place in the block, from its beginning.
    block : list of float
        What each of them has on the heap.
    tables : list of tuple
        (place in the block, place from which its number counts, table).
    """

    fields: dict[str, int] = field(default_factory=lambda: {"mode": OPEN})
    offsets: dict[str, int] = field(default_factory=dict)
    block: list[float] = field(default_factory=list)
    tables: list[tuple[int, int, Table]] = field(default_factory=list)

    def store(self, name: str, values: Sequence[float]) -> int:
        """Append values, to which an entry leads; return where they begin."""
        start = self.offsets[name] = len(self.block)
        self.block += values
        return start


def lay_contacts(
    memory: Memory, heap: Heap, contacts: Sequence[Contact], table: ContactTable, kinds: Kinds, places: Places
) -> None:
    """Lay the contacts, and reserve the Jacobians of the slots."""
    n = len(contacts)
    rows = memory.array("catalogue", len(CATALOGUE) * n).reshape(n, len(CATALOGUE))
    tried = set[tuple[Any, ...]]()
    for numbers in kinds:
        kind = kind_of(memory, contacts[numbers[0]], tried)
        starts = heap.repeat(kind.block, len(numbers)) + len(kind.block) * np.arange(len(numbers))
        row, leads = np.zeros(len(CATALOGUE), np.int64), np.zeros(len(CATALOGUE), np.int64)
        for name, value in kind.fields.items():
            row[COLUMN[name]] = value
        for name, offset in kind.offsets.items():
            row[COLUMN[name]], leads[COLUMN[name]] = offset, 1
        rows[numbers] = row + leads * starts[:, None]
        for place, start, shared in kind.tables:
            for begin in starts.tolist():
                heap.refer(begin + place, begin + start, shared)
    _lay_states(memory, contacts, kinds, rows)
    size = 3 * _lay_sides(rows, table, places)
    floats = memory.array("catalogue_floats", CATALOGUE_FLOATS * n).reshape(n, CATALOGUE_FLOATS)
    floats[:, DIRECTION], floats[:, LEVERS : LEVERS + 2], floats[:, SIZE] = 1.0, table.levers, table.extents.min(axis=1)
    floats[:, REVOLUTION : REVOLUTION + 3] = table.revolutions
    lay_law_floats(memory, contacts, kinds)
    slots = int(memory.scalars["n_slots"][0])
    for name in ("jacobian_a", "jacobian_b", "response_a", "response_b"):
        memory.array(name, slots)[:] = heap.block(size * slots) + size * np.arange(slots)


def by_kind(contacts: Sequence[Contact]) -> Kinds:
    """Return the numbers of the contacts of each kind: those of the same geometry and laws."""
    same = defaultdict[tuple[int, ...], list[int]](list)
    parts = [map(id, map(attrgetter(part), contacts)) for part in ("kinematics", "normal", "friction", "impact")]
    for number, key in enumerate(zip(*parts, strict=True)):
        same[key].append(number)
    return list(same.values())


def _lay_states(memory: Memory, contacts: Sequence[Contact], kinds: Kinds, rows: np.ndarray) -> None:
    """Say where the inner states of each contact stand, and how large they usually are."""
    scales: list[float] = []
    laws = [(numbers, contacts[numbers[0]].friction) for numbers in kinds]
    with_states = [(numbers, law) for numbers, law in laws if isinstance(law, (TractionLaw, StatefulFrictionLaw))]
    for number, law in sorted(((number, law) for numbers, law in with_states for number in numbers), key=itemgetter(0)):
        rows[number, COLUMN["state"]] = len(scales)
        scales += law.state_scale
    n_y = int(memory.scalars["n_y"][0])
    memory.array("y_scale", n_y)[n_y - len(scales) :] = scales


def _lay_sides(rows: np.ndarray, table: ContactTable, places: Places) -> int:
    """Say on which bodies and frames the contacts are; return the most velocities of an articulation among these."""
    stand, most = [*places.values()], 0
    # a mechanism need not have a frame, nor a contact then
    first = np.array([next(iter(place.frames), 0) for place in stand], np.int64)
    sizes = np.array([place.articulation_nu for place in stand], np.int64)
    said = {
        "nu": np.array([place.nu for place in stand]),
        "shift": np.array([place.shift for place in stand]),
        "articulation": np.array([place.articulation for place in stand]),
    }
    for side, which in (("a", 0), ("b", 1)):
        body, frame = table.bodies[:, which], table.frames[:, which]
        rows[:, COLUMN[f"body_{side}"]] = body
        rows[:, COLUMN[f"frame_{side}"]] = first[body] + (FRAME + 6 * said["nu"][body]) * frame
        for name, values in said.items():
            rows[:, COLUMN[f"{name}_{side}"]] = values[body]
        most = max(most, int(sizes[body].max(initial=0)))
    return most


def lay_law_floats(memory: Memory, contacts: Sequence[Contact], kinds: Kinds) -> None:
    """Lay what the catalogue holds of each contact in floats, of its laws and of forces that nobody has asked for."""
    floats = memory.array("catalogue_floats", CATALOGUE_FLOATS * len(contacts)).reshape(len(contacts), CATALOGUE_FLOATS)
    for numbers in kinds:
        normal, impact = contacts[numbers[0]].normal, contacts[numbers[0]].impact
        floats[numbers, CONTACT_TIME] = 0.0 if impact is None else impact.contact_time
        floats[numbers, MEAN_ASKED] = -math.inf
        floats[numbers, REACH] = normal.reach if isinstance(normal, CompliantNormalLaw) else 0.0


def initial_state(contact: Contact) -> tuple[float, ...]:
    """Return the inner states from which the friction of a contact starts."""
    law = contact.friction
    return law.initial_state if isinstance(law, (TractionLaw, StatefulFrictionLaw)) else ()


def kind_of(memory: Memory, contact: Contact, tried: set[tuple[Any, ...]] | None = None) -> Kind:
    """Compile what a contact and all of its kind call, and pick the parameters.

    ``tried`` keeps which functions with tables were tried out; without it none of them is.
    """
    impact, made = contact.impact, Kind()
    functions: list[_Function] = [
        ("geometry", contact.kinematics.evaluator, "pair", contact.kinematics.parameters()),
        *_friction_functions(contact.friction),
    ]
    if isinstance(contact.normal, CompliantNormalLaw):
        functions.append(("normal", contact.normal.force, "compliance", contact.normal.parameters()))
    if isinstance(impact, ImpactProcess):
        functions.append(("force", impact.force, "scalar", impact.parameters()))
        functions.append(("efficiency", impact.efficiency, "scalar", impact.parameters()))
    owners = {"geometry": contact.kinematics, "normal": contact.normal, "force": impact, "efficiency": impact}
    start = initial_state(contact)
    for name, function, form, available in functions:
        owner = f"{type(owners.get(name, contact.friction)).__name__} ({contact})"
        tables = {n: v for n in parameter_names(function, form) if isinstance(v := available.get(n), Table)}
        address, values = bind(function, form, {**available, **dict.fromkeys(tables, ())}, owner)
        if form == "pair":
            kind = function, *map(id, tables.values())
            if not tables or (tried is not None and kind not in tried):
                if tried is not None:
                    tried.add(kind)
                whole = bind(function, form, available, owner)[1] if tables else values
                try_out(function, form, available, whole, PAIR, owner)
        elif form == "traction":
            given = 1.0, (0.1, 0.2, 0.3, 0.4, 0.5), start
            try_out(function, form, available, values, FORCE_AND_MOMENT + len(start), owner, given)
        elif form == "rates":
            try_out(function, form, available, values, len(start), owner, (0.1, start))
        made.fields[f"{name}_function"] = address
        at = made.store(f"{name}_parameters", values)
        made.tables += [(at + parameter_place(function, form, n), at, table) for n, table in tables.items()]
        if name == "geometry" and contact.kinematics.candidates is not None:
            made.offsets["candidate"] = at + vector_place(function, form, values, "candidate")
        if name == "friction" and isinstance(contact.friction, StatefulFrictionLaw):
            made.offsets["state_copy"] = at + _place_of_state(contact.friction, values)
    if start or isinstance(contact.friction, TractionLaw):
        made.fields["n_state"] = len(start)
        made.store("state_start", start)
        made.store("traction_out", output_block(FORCE_AND_MOMENT + len(start)))
        made.store("rates_out", output_block(len(start)))
    if isinstance(contact.friction, AnisotropicFrictionLaw):
        law, on_second = contact.friction, float(contact.friction.body == "second")
        made.fields["oriented"] = 1
        made.store("axis", (on_second, *np.divide(law.axis, math.hypot(*law.axis)).tolist(), *law.ratios))
    if isinstance(impact, ImpactMap):
        made.store("map_parameters", _map_values(memory, impact))
    return made


def _friction_functions(law: TangentialLaw) -> list[_Function]:
    if isinstance(law, TractionLaw):
        return [("traction", law.traction, "traction", law.parameters())]
    if isinstance(law, StatefulFrictionLaw):
        offered = {**law.parameters(), "state": law.initial_state}
        return [("friction", law.coefficient, "scalar", offered), ("rates", law.rates, "rates", law.parameters())]
    assert isinstance(law, FrictionLaw)
    return [("friction", law.coefficient, "scalar", law.parameters())]


def _place_of_state(law: StatefulFrictionLaw, values: Sequence[float]) -> int:
    names = parameter_names(law.coefficient, "scalar")
    if "state" not in names:
        raise InvalidInput(
            f"{type(law).__name__}.coefficient",
            "must take the vector `state` among its arguments",
            names,
            "Write coefficient(speed, state, ...), or subclass FrictionLaw if there is no state.",
        )
    return vector_place(law.coefficient, "scalar", values, "state")


def _map_values(memory: Memory, impact: ImpactMap) -> tuple[float, ...]:
    """Compile a law that maps velocities; return its parameters."""
    names = parameter_names(impact.impulses, "map")
    if names[:1] != ("friction",):
        raise InvalidInput(
            f"{type(impact).__name__}.impulses",
            "must take friction as the first of its own arguments",
            names,
            "Write impulses(n, delassus, rates, out, friction, ...).",
        )
    offered: dict[str, Value] = {**impact.parameters(), "friction": 0.0}
    address, values = bind(impact.impulses, "map", offered, type(impact).__name__)
    single = 1, tuple(2.0 * np.eye(3).ravel()), (-1.0, 0.2, 0.1)
    try_out(impact.impulses, "map", offered, values, 3, type(impact).__name__, single)
    memory.scalars["impact_map"] = address
    return values[1:]
