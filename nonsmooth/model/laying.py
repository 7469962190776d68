"""Bodies, joints, loads and guards, each laid into the engine's memory."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from nonsmooth.binding.bounds import FRAMES, try_out
from nonsmooth.binding.compile import bind
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import FRAME, JOINT_ROW, LOAD
from nonsmooth.engine.memory.memory import Heap, Memory
from nonsmooth.interfaces import Body, Joint, Load
from nonsmooth.interfaces.body import Vector
from nonsmooth.model.articulations import Articulation
from nonsmooth.parameters import Value
from nonsmooth.system.contact import Tie
from nonsmooth.system.system import System


@dataclass
class Place:
    """Where a body stands: its number, velocities and the first of them, frames on the heap, and its articulation."""

    number: int
    nu: int
    u: int
    frames: tuple[int, ...]
    articulation: int = -1
    shift: int = 0
    articulation_nu: int = 0


Places = Mapping[int, Place]


def _write(memory: Memory, owner: type, number: int, values: Mapping[str, float]) -> None:
    for name, value in values.items():
        memory[getattr(owner, name)][number] = value


def lay_bodies(system: System, memory: Memory, heap: Heap) -> dict[int, Place]:
    """Lay the bodies; return where each stands, by its id."""
    gravity = dict(zip(("gravity_x", "gravity_y", "gravity_z"), system.gravity, strict=True))
    n_q = sum(body.n_q for body in system.bodies)
    scale = memory[owners.Step.y_scale][: int(memory[owners.Model.n_y])]
    held = {id(body) for tie in (*system.joints, *system.loads) for body in (tie.first, tie.second)}
    places = {}
    i_q = i_u = 0
    for i, body in enumerate(system.bodies):
        offered, owner = {**body.parameters(), **gravity}, type(body).__name__
        address, values = bind(body.evaluator, "body", offered, owner)
        frame = FRAME + 6 * body.n_u
        tail = len(body.frames) * frame
        size = tail + body.n_q + body.n_u + body.n_u**2 + 2
        q, u = system.start(body)
        try_out(body.evaluator, "body", offered, values, size, owner, (0.0, tuple(q), tuple(u)))
        out = heap.output(size)
        fields = {
            "q": i_q,
            "u": i_u,
            "n_q": body.n_q,
            "n_u": body.n_u,
            "function": address,
            "parameters": heap.store(values),
            "out": out,
            "tail": out + tail,
            "quaternion": body.quaternion,
            "spin": body.spin,
        }
        if body.flight is not None and id(body) not in held:
            fields |= _flight(body.flight, body, offered, heap, (q, u))
        _write(memory, owners.Body, i, fields)
        places[id(body)] = Place(i, body.n_u, i_u, tuple(out + frame * f for f in range(len(body.frames))))
        q_scale, u_scale = body.scales
        first = n_q + i_u
        scale[i_q : i_q + body.n_q], scale[first : first + body.n_u] = q_scale, u_scale
        i_q, i_u = i_q + body.n_q, i_u + body.n_u
    return places


def _flight(
    function: Callable[..., None], body: Body, offered: Mapping[str, Value], heap: Heap, start: Sequence[Vector]
) -> Mapping[str, int]:
    """Lay the function of a body that knows where it flies."""
    owner, size = type(body).__name__, body.n_q + body.n_u
    address, values = bind(function, "body", offered, owner)
    try_out(function, "body", offered, values, size, owner, (0.0, *map(tuple, start)))
    return {
        "ballistic_function": address,
        "ballistic_parameters": heap.store(values),
        "ballistic_out": heap.output(size),
    }


def lay_joints(memory: Memory, heap: Heap, articulations: Sequence[Articulation], places: Places) -> None:
    """Lay the articulations and, articulation by articulation, their joints."""
    joint = 0
    for number, articulation in enumerate(articulations):
        bodies, ties = articulation.bodies, articulation.joints
        u, n = places[id(bodies[0])].u, sum(body.n_u for body in bodies)
        for body in bodies:
            place = places[id(body)]
            place.articulation, place.shift, place.articulation_nu = number, place.u - u, n
        first, rows = joint, 0
        for tie in ties:
            rows += _lay_joint(memory, heap, joint, tie, rows, places)
            joint += 1
        fields = {
            "u": u,
            "n_u": n,
            "first_body": articulation.first,
            "n_bodies": len(bodies),
            "inverse": heap.block(n * n) if ties else _inverse(memory, articulation.first),
            "first_joint": first,
            "n_joints": len(ties),
            "n_rows": rows,
            "is_driven": int(any(tie.first.n_u == 0 or tie.second.n_u == 0 for tie in ties)),
            "jacobian": heap.block(rows * n),
            "response": heap.block(rows * n),
            "solved_response": heap.block(rows * n),
            "factor": heap.block(rows * rows),
            "residual": heap.block(rows),
            "rate": heap.block(rows),
            "bias": heap.block(rows),
            "forces": heap.block(rows),
        }
        _write(memory, owners.Articulation, number, fields)


def _inverse(memory: Memory, body: int) -> int:
    """Return where a body writes its M^-1."""
    return int(memory[owners.Body.tail][body] + memory[owners.Body.n_q][body] + memory[owners.Body.n_u][body])


def _lay_joint(memory: Memory, heap: Heap, number: int, tie: Tie, first: int, places: Places) -> int:
    joint = tie.component
    assert isinstance(joint, Joint)
    offered, owner, size = joint.parameters(), type(joint).__name__, JOINT_ROW * joint.n_rows
    address, values = bind(joint.evaluator, "pair", offered, owner)
    try_out(joint.evaluator, "pair", offered, values, size, owner)
    fields = {
        "function": address,
        "parameters": heap.store(values),
        "first_row": first,
        "n_rows": joint.n_rows,
        "out": heap.output(size),
    }
    for side, body, frame in (("a", tie.first, tie.frames[0]), ("b", tie.second, tie.frames[1])):
        place = places[id(body)]
        fields[f"frame_{side}"] = place.frames[frame]
        fields[f"n_u_{side}"] = body.n_u
        fields[f"column_{side}"] = place.shift
    _write(memory, owners.Joint, number, fields)
    return joint.n_rows


def lay_loads(system: System, memory: Memory, heap: Heap, places: Places) -> None:
    """Lay the loads."""
    for number, tie in enumerate(system.loads):
        load = tie.component
        assert isinstance(load, Load)
        offered, owner = load.parameters(), type(load).__name__
        address, values = bind(load.evaluator, "load", offered, owner)
        try_out(load.evaluator, "load", offered, values, LOAD, owner, (0.0, *FRAMES))
        fields = {
            "function": address,
            "parameters": heap.store(values),
            "out": heap.output(LOAD),
            "depends_on_time": load.depends_on_time,
        }
        for side, body, frame in (("a", tie.first, tie.frames[0]), ("b", tie.second, tie.frames[1])):
            fields[f"frame_{side}"] = places[id(body)].frames[frame]
            fields[f"body_{side}"] = places[id(body)].number
        _write(memory, owners.Load, number, fields)


def lay_guards(system: System, memory: Memory, heap: Heap) -> None:
    """Lay the guards of the scenario's own."""
    for number, guard in enumerate(system.guards):
        address, values = bind(guard.value, "guard", guard.parameters(), type(guard).__name__)
        fields = {"function": address, "parameters": heap.store(values), "ends_the_run": int(guard.ends_run)}
        _write(memory, owners.OwnGuard, number, fields)
