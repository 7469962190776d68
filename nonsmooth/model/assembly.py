"""From a System to the engine's memory."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from nonsmooth.engine.kernel import call_room, room_addresses
from nonsmooth.engine.record import CODE_HEAD, EVENT_HEAD
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body, ImpactMap, ImpactProcess
from nonsmooth.interfaces.guard import guard_value
from nonsmooth.model.layout import FRAME, GEOMETRY, Memory, allocate
from nonsmooth.model.options import Options
from nonsmooth.plugins.compile import bind, parameter_names
from nonsmooth.system.contact import Contact
from nonsmooth.system.system import System

_EVENT_ROWS = 4096
_SAMPLE_ROWS = 4096
N_ACCOUNTS = 3
"""Energies integrated with the state: work of driven bodies, loss to friction, gross exchange."""


@dataclass(frozen=True)
class Model:
    """A system laid out in memory, ready to run.

    Attributes
    ----------
    system : System
        What it was made from.
    memory : Memory
        Scalars and heaps.
    n_q, n_u : int
        Numbers of coordinates and velocities of all bodies.
    """

    system: System
    memory: Memory
    n_q: int
    n_u: int

    @property
    def n_y(self) -> int:
        """Length of the integrated state: q, u, accounts."""
        return self.n_q + self.n_u + N_ACCOUNTS

    @property
    def event_width(self) -> int:
        """Floats of an event."""
        return event_width(len(self.system.contacts), self.n_q, self.n_u)

    @property
    def code_width(self) -> int:
        """Integers of an event."""
        return CODE_HEAD + len(self.system.contacts)

    def energy(self) -> tuple[float, float]:
        """Return kinetic and potential energy [J] of the present state."""
        bodies = self.system.bodies
        call_room("evaluate_at", self.memory)
        kinetic = potential = 0.0
        outs = self.memory.array("body_out", len(bodies))
        for body, out in zip(bodies, outs, strict=True):
            if body.n_u > 0:
                end = int(out) + _block(body)
                kinetic += float(self.memory.floats[end - 2])
                potential += float(self.memory.floats[end - 1])
        return kinetic, potential

    def gaps(self) -> np.ndarray:
        """Return the gaps [m, n_contacts] at the present state."""
        call_room("evaluate_at", self.memory)
        n = len(self.system.contacts)
        return self.memory.array("geometry", GEOMETRY * n).reshape(n, GEOMETRY)[:, 0].copy()


def event_width(n_contacts: int, n_q: int, n_u: int) -> int:
    """Return the floats of an event: head, impulses, q, u before and after."""
    return EVENT_HEAD + 3 * n_contacts + n_q + 2 * n_u


def _block(body: Body) -> int:
    return FRAME + 6 * body.n_u + body.n_q + body.n_u + body.n_u**2 + 2


class _Heap:
    """Hands out the floats behind the fixed arrays."""

    def __init__(self, memory: Memory, size: int) -> None:
        self._floats = memory.floats
        self._next = len(memory.floats) - size

    def block(self, size: int) -> int:
        start = self._next
        self._next += size
        return start

    def store(self, values: tuple[float, ...]) -> int:
        start = self.block(len(values))
        self._floats[start : start + len(values)] = values
        return start


def assemble(system: System, options: Options) -> Model:
    """Lay out a validated system.

    Raises
    ------
    InvalidInput
        If bodies overlap at the start.
    """
    bodies, contacts = system.bodies, system.contacts
    n_q = sum(body.n_q for body in bodies)
    n_u = sum(body.n_u for body in bodies)
    counts = {
        "n_bodies": len(bodies),
        "n_contacts": len(contacts),
        "n_own_guards": len(system.guards),
        "n_q": n_q,
        "n_u": n_u,
        "n_y": n_q + n_u + N_ACCOUNTS,
        "map_width": _map_width(contacts),
        "event_capacity": _EVENT_ROWS,
        "event_width": event_width(len(contacts), n_q, n_u),
        "sample_capacity": _SAMPLE_ROWS,
    }
    size = sum(_block(body) + 40 for body in bodies)
    size += sum(12 * (c.first.n_u + c.second.n_u) + 80 for c in contacts)
    size += sum(40 for _guard in system.guards)
    memory = allocate(counts, size)
    heap = _Heap(memory, size)
    memory.array("rooms", len(room_addresses()))[:] = room_addresses()
    model = Model(system, memory, n_q, n_u)
    _lay_bodies(model, heap)
    for number, contact in enumerate(contacts):
        _lay_contact(model, heap, number, contact)
    _lay_guards(model, heap)
    _set_scalars(model, options)
    _check_start(model)
    return model


def _map_width(contacts: tuple[Contact, ...]) -> int:
    if contacts and isinstance(contacts[0].impact, ImpactMap):
        return len(parameter_names(contacts[0].impact.impulses, "map"))
    return 1


def _lay_bodies(model: Model, heap: _Heap) -> None:
    system, memory = model.system, model.memory
    gravity = dict(zip(("gravity_x", "gravity_y", "gravity_z"), system.gravity, strict=True))
    i_q = i_u = 0
    y = memory.array("y", model.n_y)
    scale = memory.array("y_scale", model.n_y)
    for i, body in enumerate(system.bodies):
        address, values = bind(body.evaluator, "body", body.parameters() | gravity, type(body).__name__)
        fields = {
            "q": i_q,
            "u": i_u,
            "nq": body.n_q,
            "nu": body.n_u,
            "function": address,
            "parameters": heap.store(values),
            "out": heap.block(_block(body)),
            "quaternion": body.quaternion,
        }
        for name, value in fields.items():
            memory.array(f"body_{name}", i + 1)[i] = value
        q, u = system.start(body)
        q_scale, u_scale = body.scales
        y[i_q : i_q + body.n_q], scale[i_q : i_q + body.n_q] = q, q_scale
        first = model.n_q + i_u
        y[first : first + body.n_u], scale[first : first + body.n_u] = u, u_scale
        i_q, i_u = i_q + body.n_q, i_u + body.n_u


def _lay_contact(model: Model, heap: _Heap, number: int, contact: Contact) -> None:
    memory, bodies = model.memory, model.system.bodies
    owner = contact.name
    functions = {
        "geometry": (contact.kinematics.evaluator, "pair", contact.kinematics.parameters()),
        "friction": (contact.friction.coefficient, "scalar", contact.friction.parameters()),
    }
    impact = contact.impact
    if isinstance(impact, ImpactProcess):
        functions["force"] = (impact.force, "scalar", impact.parameters())
        functions["efficiency"] = (impact.efficiency, "scalar", impact.parameters())
    elif isinstance(impact, ImpactMap):
        names = parameter_names(impact.impulses, "map")
        if names[:1] != ("friction",):
            raise InvalidInput(
                f"{type(impact).__name__}.impulses",
                "must take friction as the first of its own arguments",
                names,
                "Write impulses(n, delassus, rates, out, friction, ...).",
            )
        address, values = bind(impact.impulses, "map", impact.parameters() | {"friction": 0.0}, type(impact).__name__)
        memory.scalars["impact_map"] = address
        memory.array("map_parameters", number + 1)[number] = heap.store(values[1:])
    for name, (function, form, available) in functions.items():
        address, values = bind(function, form, available, owner)
        memory.array(f"{name}_function", number + 1)[number] = address
        memory.array(f"{name}_parameters", number + 1)[number] = heap.store(values)
    for side, body in (("a", contact.first), ("b", contact.second)):
        index = next(i for i, other in enumerate(bodies) if other is body)
        memory.array(f"body_{side}", number + 1)[number] = index
        memory.array(f"jacobian_{side}", number + 1)[number] = heap.block(3 * body.n_u)
        memory.array(f"response_{side}", number + 1)[number] = heap.block(3 * body.n_u)
    memory.array("contact_time", number + 1)[number] = impact.contact_time
    memory.array("direction", 2 * number + 2)[2 * number] = 1.0


def _lay_guards(model: Model, heap: _Heap) -> None:
    y = model.memory.array("y", model.n_y)
    for number, guard in enumerate(model.system.guards):
        value = guard_value(guard, 0.0, y[: model.n_q], y[model.n_q : model.n_q + model.n_u])
        if not isinstance(value, float) or not math.isfinite(value):
            raise InvalidInput(
                f"{type(guard).__name__}.value",
                "must return a finite number at the start",
                value,
                f"Look at {guard.value.__qualname__} with t = 0 and the q and u of the start.",
            )
        address, values = bind(guard.value, "guard", guard.parameters(), type(guard).__name__)
        fields = {"function": address, "parameters": heap.store(values), "ends": int(guard.ends_run)}
        for name, value in fields.items():
            model.memory.array(f"own_guard_{name}", number + 1)[number] = value


def _set_scalars(model: Model, options: Options) -> None:
    scalars = model.memory.scalars
    step = min(options.largest_step, model.system.time_scale / options.steps_per_period)
    values = {
        "rtol": options.tolerance,
        "impact_rtol": options.impact_tolerance,
        "time_tolerance": options.time_tolerance,
        "gap_tolerance": options.gap_tolerance,
        "velocity_tolerance": options.velocity_tolerance,
        "h_max": step,
        "h_free": step,
        "h_closed": step,
        "last_event_t": -math.inf,
        "driven_t": -math.inf,
    }
    for name, value in values.items():
        scalars[name] = value


def _check_start(model: Model) -> None:
    for contact, gap in zip(model.system.contacts, model.gaps(), strict=True):
        allowed = max(1e-9, 1e-6 * max(s.length for s in (*contact.first.shapes, *contact.second.shapes)))
        if not gap >= -allowed:
            raise InvalidInput(
                f"start of the {contact.name}",
                "must not overlap",
                float(gap),
                "Place the bodies apart or touching (gap >= 0 [m]).",
            )
