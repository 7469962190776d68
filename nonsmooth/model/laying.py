"""Writes bodies, joints, loads and guards into the memory: addresses of their functions, parameters and blocks."""

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
class BodyLayout:
    """Where the numbers of a body are.

    Attributes
    ----------
    number : int
        Number of the body.
    n_u, u : int
        Number of its velocities, and number of the first one in the system.
    frames : tuple of int
        Places of its frames among the floats of the memory.
    articulation : int
        Number of its articulation.
    column : int
        Number of its first velocity in the articulation.
    articulation_n_u : int
        Number of velocities of the articulation.
    """

    number: int
    n_u: int
    u: int
    frames: tuple[int, ...]
    articulation: int = -1
    column: int = 0
    articulation_n_u: int = 0


BodyLayouts = Mapping[int, BodyLayout]
"""Layouts by the identity of the body."""


def _write(memory: Memory, owner: type, number: int, values: Mapping[str, float]) -> None:
    """Write fields of a record, by their names."""
    for name, value in values.items():
        memory[getattr(owner, name)][number] = value


def lay_bodies(system: System, memory: Memory, blocks: Heap) -> dict[int, BodyLayout]:
    """Write the bodies; the result has the layout of each."""
    gravity = dict(zip(("gravity_x", "gravity_y", "gravity_z"), system.gravity, strict=True))
    n_q = sum(body.n_q for body in system.bodies)
    scale = memory[owners.Step.y_scale][: int(memory[owners.Model.n_y])]
    constrained = {id(body) for tie in (*system.joints, *system.loads) for body in (tie.first, tie.second)}
    layouts = {}
    q = u = 0
    for number, body in enumerate(system.bodies):
        available, start = {**body.parameters(), **gravity}, system.start(body)
        fields = {"q": q, "u": u, **_body_fields(body, available, blocks, start)}
        if body.flight is not None and id(body) not in constrained:
            fields |= _ballistic_fields(body.flight, body, available, blocks, start)
        _write(memory, owners.Body, number, fields)
        frames = tuple(fields["out"] + (FRAME + 6 * body.n_u) * frame for frame in range(len(body.frames)))
        layouts[id(body)] = BodyLayout(number, body.n_u, u, frames)
        scale[q : q + body.n_q], scale[n_q + u : n_q + u + body.n_u] = body.scales
        q, u = q + body.n_q, u + body.n_u
    return layouts


def _body_fields(body: Body, available: Mapping[str, Value], blocks: Heap, start: Sequence[Vector]) -> dict[str, int]:
    """Fields of a body, apart from the numbers of its first coordinate and velocity."""
    owner = type(body).__name__
    address, values = bind(body.evaluator, "body", available, owner)
    tail = len(body.frames) * (FRAME + 6 * body.n_u)
    size = tail + body.n_q + body.n_u + body.n_u**2 + 2
    try_out(body.evaluator, "body", available, values, size, owner, (0.0, *map(tuple, start)))
    out = blocks.output(size)
    return {
        "n_q": body.n_q,
        "n_u": body.n_u,
        "function": address,
        "parameters": blocks.store(values),
        "out": out,
        "tail": out + tail,
        "quaternion": body.quaternion,
        "spin": body.spin,
    }


def _ballistic_fields(
    function: Callable[..., None], body: Body, available: Mapping[str, Value], blocks: Heap, start: Sequence[Vector]
) -> Mapping[str, int]:
    """Fields of a body whose ballistic motion has a closed form."""
    owner, size = type(body).__name__, body.n_q + body.n_u
    address, values = bind(function, "body", available, owner)
    try_out(function, "body", available, values, size, owner, (0.0, *map(tuple, start)))
    return {
        "ballistic_function": address,
        "ballistic_parameters": blocks.store(values),
        "ballistic_out": blocks.output(size),
    }


def lay_joints(memory: Memory, blocks: Heap, articulations: Sequence[Articulation], layouts: BodyLayouts) -> None:
    """Write the articulations, and the joints in the order of the articulations."""
    joint = 0
    for number, articulation in enumerate(articulations):
        bodies, ties = articulation.bodies, articulation.joints
        u, n = layouts[id(bodies[0])].u, sum(body.n_u for body in bodies)
        for layout in (layouts[id(body)] for body in bodies):
            layout.articulation, layout.column, layout.articulation_n_u = number, layout.u - u, n
        first, rows = joint, 0
        for tie in ties:
            rows += _lay_joint(memory, blocks, joint, tie, rows, layouts)
            joint += 1
        fields = {
            "u": u,
            "n_u": n,
            "first_body": articulation.first,
            "n_bodies": len(bodies),
            "inverse": blocks.block(n * n) if ties else _inverse_mass(memory, articulation.first),
            "first_joint": first,
            "n_joints": len(ties),
            "n_rows": rows,
            "is_driven": any(tie.first.n_u == 0 or tie.second.n_u == 0 for tie in ties),
            "jacobian": blocks.block(rows * n),
            "response": blocks.block(rows * n),
            "solved_response": blocks.block(rows * n),
            "factor": blocks.block(rows * rows),
            "residual": blocks.block(rows),
            "rate": blocks.block(rows),
            "bias": blocks.block(rows),
            "forces": blocks.block(rows),
        }
        _write(memory, owners.Articulation, number, fields)


def _inverse_mass(memory: Memory, body: int) -> int:
    """Place where a body writes its inverse mass."""
    return int(memory[owners.Body.tail][body] + memory[owners.Body.n_q][body] + memory[owners.Body.n_u][body])


def _lay_joint(memory: Memory, blocks: Heap, number: int, tie: Tie, first: int, layouts: BodyLayouts) -> int:
    """Write a joint whose rows begin at ``first`` in its articulation; the result is the number of its rows."""
    joint = tie.component
    assert isinstance(joint, Joint)
    available, owner, size = joint.parameters(), type(joint).__name__, JOINT_ROW * joint.n_rows
    address, values = bind(joint.evaluator, "pair", available, owner)
    try_out(joint.evaluator, "pair", available, values, size, owner)
    fields = {
        "function": address,
        "parameters": blocks.store(values),
        "first_row": first,
        "n_rows": joint.n_rows,
        "out": blocks.output(size),
    }
    for side, body, frame in (("a", tie.first, tie.frames[0]), ("b", tie.second, tie.frames[1])):
        layout = layouts[id(body)]
        fields[f"frame_{side}"] = layout.frames[frame]
        fields[f"n_u_{side}"] = body.n_u
        fields[f"column_{side}"] = layout.column
    _write(memory, owners.Joint, number, fields)
    return joint.n_rows


def lay_loads(system: System, memory: Memory, blocks: Heap, layouts: BodyLayouts) -> None:
    """Write the loads."""
    for number, tie in enumerate(system.loads):
        load = tie.component
        assert isinstance(load, Load)
        available, owner = load.parameters(), type(load).__name__
        address, values = bind(load.evaluator, "load", available, owner)
        try_out(load.evaluator, "load", available, values, LOAD, owner, (0.0, *FRAMES))
        fields = {
            "function": address,
            "parameters": blocks.store(values),
            "out": blocks.output(LOAD),
            "depends_on_time": load.depends_on_time,
        }
        for side, body, frame in (("a", tie.first, tie.frames[0]), ("b", tie.second, tie.frames[1])):
            fields[f"frame_{side}"] = layouts[id(body)].frames[frame]
            fields[f"body_{side}"] = layouts[id(body)].number
        _write(memory, owners.Load, number, fields)


def lay_guards(system: System, memory: Memory, blocks: Heap) -> None:
    """Write the guards of the user."""
    for number, guard in enumerate(system.guards):
        address, values = bind(guard.value, "guard", guard.parameters(), type(guard).__name__)
        fields = {"function": address, "parameters": blocks.store(values), "ends_the_run": guard.ends_run}
        _write(memory, owners.OwnGuard, number, fields)
