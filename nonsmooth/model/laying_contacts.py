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
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import CANDIDATE, FORCE_AND_MOMENT, FRAME, PAIR
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

_Function: TypeAlias = tuple[str, Callable[..., Any], str, Mapping[str, Value]]
"""Name, function, form, parameters that it may ask for."""
Kinds: TypeAlias = Sequence[list[int]]
"""The numbers of the contacts of each kind."""


@dataclass
class Kind:
    """What contacts of the same geometry and laws have in common.

    Attributes
    ----------
    fields : dict
        Numbers of the declared contacts.
    offsets : dict
        Those that lead to a place in the block, from its beginning.
    block : list of float
        What each of them has on the heap.
    written : list of tuple
        (place in the block, length) of what the engine or a law writes there.
    tables : list of tuple
        (place in the block, place from which its number counts, table).
    """

    fields: dict[str, int] = field(default_factory=lambda: {"mode": OPEN})
    offsets: dict[str, int] = field(default_factory=dict)
    block: list[float] = field(default_factory=list)
    written: list[tuple[int, int]] = field(default_factory=list)
    tables: list[tuple[int, int, Table]] = field(default_factory=list)

    def store(self, name: str, values: Sequence[float]) -> int:
        """Append values, to which an entry leads; return where they begin."""
        start = self.offsets[name] = len(self.block)
        self.block += values
        return start

    def output(self, name: str, size: int) -> None:
        """Append numbers that a law writes, to which an entry leads."""
        self.written.append((self.store(name, output_block(size)), size))


def lay_contacts(
    memory: Memory, heap: Heap, contacts: Sequence[Contact], table: ContactTable, kinds: Kinds, places: Places
) -> None:
    """Lay the contacts, and reserve the Jacobians of the slots."""
    tried = set[tuple[Any, ...]]()
    for numbers in kinds:
        kind = kind_of(memory, contacts[numbers[0]], tried)
        starts = heap.repeat(kind.block, len(numbers)) + len(kind.block) * np.arange(len(numbers))
        for place, size in kind.written:
            heap.write(starts + place, size)
        for name, value in kind.fields.items():
            memory.declared(getattr(owners.Contact, name))[numbers] = value
        for name, offset in kind.offsets.items():
            memory.declared(getattr(owners.Contact, name))[numbers] = offset + starts
        for place, start, shared in kind.tables:
            for begin in starts.tolist():
                heap.refer(begin + place, begin + start, shared)
    _lay_states(memory, contacts, kinds)
    size = 3 * _lay_sides(memory, table, places)
    memory.declared(owners.Contact.direction)[:, 0] = 1.0
    memory.declared(owners.Contact.support_radius_a)[:] = table.levers[:, 0]
    memory.declared(owners.Contact.support_radius_b)[:] = table.levers[:, 1]
    memory.declared(owners.Contact.size)[:] = table.extents.min(axis=1)
    memory.declared(owners.Contact.spin_axis)[:] = table.revolutions
    lay_law_floats(memory, contacts, kinds)
    slots = int(memory[owners.Model.n_slots])
    contact = owners.Contact
    for place in (contact.jacobian_a, contact.jacobian_b, contact.response_a, contact.response_b):
        memory[place] = heap.block(size * slots) + size * np.arange(slots)


def by_kind(contacts: Sequence[Contact]) -> Kinds:
    """Return the numbers of the contacts of each kind: those of the same geometry and laws."""
    same = defaultdict[tuple[int, ...], list[int]](list)
    parts = [map(id, map(attrgetter(part), contacts)) for part in ("kinematics", "normal", "friction", "impact")]
    for number, key in enumerate(zip(*parts, strict=True)):
        same[key].append(number)
    return list(same.values())


def _lay_states(memory: Memory, contacts: Sequence[Contact], kinds: Kinds) -> None:
    """Say where the inner states of each contact stand, and how large they usually are."""
    scales: list[float] = []
    laws = [(numbers, contacts[numbers[0]].friction) for numbers in kinds]
    with_states = [(numbers, law) for numbers, law in laws if isinstance(law, (TractionLaw, StatefulFrictionLaw))]
    for number, law in sorted(((number, law) for numbers, law in with_states for number in numbers), key=itemgetter(0)):
        memory.declared(owners.Contact.inner_states)[number] = len(scales)
        scales += law.state_scale
    n_y = int(memory[owners.Model.n_y])
    memory[owners.Step.y_scale][:n_y][n_y - len(scales) :] = scales


def _lay_sides(memory: Memory, table: ContactTable, places: Places) -> int:
    """Say on which bodies and frames the contacts are; return the most velocities of an articulation among these."""
    stand, most = [*places.values()], 0
    # a mechanism need not have a frame, nor a contact then
    first = np.array([next(iter(place.frames), 0) for place in stand], np.int64)
    sizes = np.array([place.articulation_nu for place in stand], np.int64)
    said = {
        "n_u": np.array([place.nu for place in stand]),
        "column": np.array([place.shift for place in stand]),
        "articulation": np.array([place.articulation for place in stand]),
    }
    for side, which in (("a", 0), ("b", 1)):
        body, frame = table.bodies[:, which], table.frames[:, which]
        found = {"body": body, "frame": first[body] + (FRAME + 6 * said["n_u"][body]) * frame}
        for name, values in (found | {name: values[body] for name, values in said.items()}).items():
            memory.declared(getattr(owners.Contact, f"{name}_{side}"))[:] = values
        most = max(most, int(sizes[body].max(initial=0)))
    return most


def lay_law_floats(memory: Memory, contacts: Sequence[Contact], kinds: Kinds) -> None:
    """Write the floats of each declared contact: those of its laws, and of averaged forces that were never tried."""
    for numbers in kinds:
        normal, impact = contacts[numbers[0]].normal, contacts[numbers[0]].impact
        memory.declared(owners.Contact.contact_time)[numbers] = 0.0 if impact is None else impact.contact_time
        memory.declared(owners.Contact.mean_forces_asked)[numbers] = -math.inf
        reach = normal.reach if isinstance(normal, CompliantNormalLaw) else 0.0
        memory.declared(owners.Contact.reach)[numbers] = reach


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
        functions.append(("impact_force", impact.force, "scalar", impact.parameters()))
        functions.append(("efficiency", impact.efficiency, "scalar", impact.parameters()))
    sources = {"geometry": contact.kinematics, "normal": contact.normal, "impact_force": impact, "efficiency": impact}
    start = initial_state(contact)
    for name, function, form, available in functions:
        owner = f"{type(sources.get(name, contact.friction)).__name__} ({contact})"
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
            made.offsets["features"] = at + vector_place(function, form, values, "candidate")
            # the features, and how far apart they may be
            made.written.append((made.offsets["features"], CANDIDATE + 1))
        if name == "friction" and isinstance(contact.friction, StatefulFrictionLaw):
            made.offsets["inner_states_copy"] = at + _place_of_state(contact.friction, values)
            made.written.append((made.offsets["inner_states_copy"], len(start)))
    if start or isinstance(contact.friction, TractionLaw):
        made.fields["n_inner_states"] = len(start)
        made.store("inner_states_at_start", start)
        made.output("traction_out", FORCE_AND_MOMENT + len(start))
        made.output("rates_out", len(start))
    if isinstance(contact.friction, AnisotropicFrictionLaw):
        law, on_second = contact.friction, float(contact.friction.body == "second")
        made.fields["is_anisotropic"] = 1
        made.store("anisotropy", (on_second, *np.divide(law.axis, math.hypot(*law.axis)).tolist(), *law.ratios))
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
    memory[owners.Options.impact_map] = address
    return values[1:]
