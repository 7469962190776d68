"""Contacts and their laws, laid into the engine's memory."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np

from nonsmooth.engine.modes import OPEN
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
from nonsmooth.model.laying import Places
from nonsmooth.model.layout import CATALOGUE, CATALOGUE_FLOATS, FORCE_AND_MOMENT, N_ACCOUNTS, PAIR
from nonsmooth.model.memory import Heap, Memory
from nonsmooth.parameters import Table, Value
from nonsmooth.plugins.bounds import try_out
from nonsmooth.plugins.compile import bind, parameter_names, parameter_place, vector_place
from nonsmooth.system.contact import Contact

_Function: TypeAlias = tuple[str, Callable[..., Any], str, Mapping[str, Value]]
"""Name in the catalogue, function, form, parameters that it may ask for."""


def lay_contacts(memory: Memory, heap: Heap, contacts: Sequence[Contact], places: Places) -> None:
    """Lay the contacts, and reserve the Jacobians of the slots."""
    tried = set[tuple[Any, ...]]()
    first_state, first = 0, int(memory.scalars["n_q"][0] + memory.scalars["n_u"][0]) + N_ACCOUNTS
    for number, contact in enumerate(contacts):
        _lay_contact(memory, heap, number, contact, places, first_state, tried)
        scales = state_scale(contact)
        n_y = int(memory.scalars["n_y"][0])
        memory.array("y_scale", n_y)[first + first_state : first + first_state + len(scales)] = scales
        first_state += len(scales)
    widths = [places[id(body)].linkage_nu for contact in contacts for body in (contact.first, contact.second)]
    widest = max(widths, default=0)
    for slot in range(int(memory.scalars["n_slots"][0])):
        for name in ("jacobian_a", "jacobian_b", "response_a", "response_b"):
            memory.array(name, slot + 1)[slot] = heap.block(3 * widest)


def initial_state(contact: Contact) -> tuple[float, ...]:
    """Return the inner states from which the friction of a contact starts."""
    law = contact.friction
    return law.initial_state if isinstance(law, (TractionLaw, StatefulFrictionLaw)) else ()


def state_scale(contact: Contact) -> tuple[float, ...]:
    """Return the usual sizes of the inner states of the friction of a contact."""
    law = contact.friction
    return law.state_scale if isinstance(law, (TractionLaw, StatefulFrictionLaw)) else ()


def _lay_contact(
    memory: Memory,
    heap: Heap,
    number: int,
    contact: Contact,
    places: Places,
    first_state: int,
    tried: set[tuple[Any, ...]],
) -> None:
    impact, reach = contact.impact, 0.0
    functions: list[_Function] = [
        ("geometry", contact.kinematics.evaluator, "pair", contact.kinematics.parameters()),
        *_friction_functions(contact.friction),
    ]
    if isinstance(contact.normal, CompliantNormalLaw):
        functions.append(("normal", contact.normal.force, "compliance", contact.normal.parameters()))
        reach = contact.normal.reach
    if isinstance(impact, ImpactProcess):
        functions.append(("force", impact.force, "scalar", impact.parameters()))
        functions.append(("efficiency", impact.efficiency, "scalar", impact.parameters()))
    owners = {"geometry": contact.kinematics, "normal": contact.normal, "force": impact, "efficiency": impact}
    start = initial_state(contact)
    fields: dict[str, int] = {"mode": OPEN}
    for name, function, form, available in functions:
        owner = f"{type(owners.get(name, contact.friction)).__name__} ({contact.name})"
        tables = {n: v for n in parameter_names(function, form) if isinstance(v := available.get(n), Table)}
        address, values = bind(function, form, {**available, **dict.fromkeys(tables, ())}, owner)
        if form == "pair":
            kind = function, *map(id, tables.values())
            if not tables or kind not in tried:
                tried.add(kind)
                whole = bind(function, form, available, owner)[1] if tables else values
                try_out(function, form, available, whole, PAIR, owner)
        elif form == "traction":
            given = 1.0, (0.1, 0.2, 0.3, 0.4, 0.5), start
            try_out(function, form, available, values, FORCE_AND_MOMENT + len(start), owner, given)
        elif form == "rates":
            try_out(function, form, available, values, len(start), owner, (0.1, (), start))
        at_tables = {parameter_place(function, form, name): table for name, table in tables.items()}
        fields |= {f"{name}_function": address, f"{name}_parameters": heap.store_with_tables(values, at_tables)}
        if name == "geometry" and contact.kinematics.candidates is not None:
            fields["candidate"] = fields["geometry_parameters"] + vector_place(function, form, values, "candidate")
        if name == "friction" and isinstance(contact.friction, StatefulFrictionLaw):
            fields["state_copy"] = fields["friction_parameters"] + _place_of_state(contact.friction, values)
    if start or isinstance(contact.friction, TractionLaw):
        fields |= {"state": first_state, "n_state": len(start), "state_start": heap.store(start)}
        fields |= {"traction_out": heap.output(FORCE_AND_MOMENT + len(start)), "rates_out": heap.output(len(start))}
    if isinstance(contact.friction, AnisotropicFrictionLaw):
        law, on_second = contact.friction, float(contact.friction.body == "second")
        axis = np.divide(law.axis, math.hypot(*law.axis))
        fields |= {"oriented": 1, "axis": heap.store((on_second, *axis, *law.ratios))}
    for side, body, frame in (("a", contact.first, contact.frames[0]), ("b", contact.second, contact.frames[1])):
        place = places[id(body)]
        fields |= {f"body_{side}": place.number, f"frame_{side}": place.frames[frame], f"nu_{side}": body.n_u}
        fields |= {f"shift_{side}": place.shift, f"linkage_{side}": place.linkage}
    if isinstance(impact, ImpactMap):
        fields["map_parameters"] = _lay_map(memory, heap, impact)
    row = memory.array("catalogue", len(CATALOGUE) * (number + 1))[len(CATALOGUE) * number :]
    for name, value in fields.items():
        row[CATALOGUE.index(name)] = value
    floats = memory.array("catalogue_floats", CATALOGUE_FLOATS * (number + 1))[CATALOGUE_FLOATS * number :]
    floats[:] = 0.0 if impact is None else impact.contact_time, 1.0, 0.0, reach, 0.0, *contact.levers, contact.size


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


def _lay_map(memory: Memory, heap: Heap, impact: ImpactMap) -> int:
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
    return heap.store(values[1:])
