"""Writes bodies, joints, loads and guards into the memory: addresses of their functions, parameters and blocks."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from nonsmooth.binding.bounds import FRAMES, try_out
from nonsmooth.binding.compile import bind
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import FRAME, JOINT_ROW, LOAD
from nonsmooth.engine.memory.heap import Heap
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.interfaces import Body, Joint, Load
from nonsmooth.interfaces.scales import EARTH
from nonsmooth.parameters import Component, Value
from nonsmooth.system.contact import Tie
from nonsmooth.system.system import System


@dataclass(frozen=True)
class ArticulationLayout:
    """Bodies of an articulation (tied together by joints), and its joints.

    Attributes
    ----------
    first : int
        Number of the first body in the system; the other bodies have the next numbers.
    bodies : tuple of Body
        The bodies.
    joints : tuple of Tie
        The joints.
    """

    first: int
    bodies: tuple[Body, ...]
    joints: tuple[Tie, ...]


def articulations(system: System) -> list[ArticulationLayout]:
    """The articulations (groups of bodies that joints tie together) of a system, in the order of its bodies.

    An articulation is a range of consecutive bodies. It contains both movable bodies of each of its joints, and it is
    as short as possible. Each body belongs to one articulation. A body between two jointed bodies belongs to their
    articulation even without a joint. This costs time and does not change the motion.

    A movable body has velocities (``n_u`` > 0), and each joint must have at least one. The motion of a driven body is
    given, so two bodies with joints to the same driven body may belong to different articulations.
    """
    bodies = system.bodies
    # number of the last body that a joint ties to each body; the body itself without a joint
    last = list(range(len(bodies)))
    for tie in system.joints:
        numbers = [i for i, body in enumerate(bodies) if (body is tie.first or body is tie.second) and body.n_u > 0]
        last[numbers[0]] = max(last[numbers[0]], numbers[-1])
    found: list[ArticulationLayout] = []
    first = 0
    while first < len(bodies):
        end = number = first
        # extend the range until no joint leads from a body of the range to a body behind the range
        while number <= end:
            end = max(end, last[number])
            number += 1
        members = bodies[first : end + 1]
        # a joint belongs to the articulation of its movable bodies; a driven body of the joint may be no member
        movable = [body for body in members if body.n_u > 0]
        joints = tuple(t for t in system.joints if any(body is t.first or body is t.second for body in movable))
        found.append(ArticulationLayout(first, members, joints))
        first = end + 1
    return found


def joints_in_order(system: System) -> list[Tie]:
    """The joints of a system in the order in which the memory has them: articulation by articulation."""
    return [joint for articulation in articulations(system) for joint in articulation.joints]


@dataclass(frozen=True)
class BodyLayout:
    """Places in the memory of the numbers of a body.

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
    articulation: int
    column: int
    articulation_n_u: int


BodyLayouts = Mapping[int, BodyLayout]
"""Layouts by the identity of the body."""


def write_record(memory: Memory, owner: type, number: int, values: Mapping[str, float]) -> None:
    """Write fields of record ``number`` of an owner, such as a body or a joint, into the memory, by their names."""
    for name, value in values.items():
        memory[getattr(owner, name)][number] = value


def _function(
    blocks: Heap,
    function: Callable[..., Any],
    form: str,
    part: Component,
    available: Mapping[str, Value],
    size: int,
    arguments: Sequence[float | Sequence[float]] = FRAMES,
) -> dict[str, int]:
    """Compile a function of ``part`` that writes ``size`` numbers, try it out, and reserve its parameters and output.

    ``form`` names the roles of its first arguments, ``available`` has the values of the others by name. The trial calls
    it once in Python with ``arguments`` for the first ones, to find one that writes past its end. The result has the
    fields of a record: address of the function, and offsets of parameters and output.
    """
    owner = type(part).__name__
    address, values = bind(function, form, available, owner)
    try_out(function, form, available, values, size, owner, arguments)
    return {"function": address, "parameters": blocks.store(values), "out": blocks.output(size)}


def lay_bodies(
    system: System,
    memory: Memory,
    blocks: Heap,
    articulations: Sequence[ArticulationLayout],
    acceleration: float,
) -> dict[int, BodyLayout]:
    """Write the bodies, and the scales of their coordinates and velocities for the error of a step.

    The result has the layout of each body, by its identity. Coordinates of all bodies come first in the state, then the
    velocities, both in the order of the bodies. Scales of velocities are those of bodies on Earth, reduced for the
    typical ``acceleration`` [m/s^2] of the system.
    """
    n_q = sum(body.n_q for body in system.bodies)
    scale = memory[owners.Step.y_scale]
    # bodies with a joint or a load have no closed form of ballistic motion
    tied = {id(body) for tie in (*system.joints, *system.loads) for body in (tie.first, tie.second)}
    layouts: dict[int, BodyLayout] = {}
    q = u = 0
    for index, articulation in enumerate(articulations):
        first_u, n_u = u, sum(body.n_u for body in articulation.bodies)
        for number, body in enumerate(articulation.bodies, articulation.first):
            frames = _lay_body(system, memory, blocks, number, id(body) in tied, {"q": q, "u": u})
            layouts[id(body)] = BodyLayout(number, body.n_u, u, frames, index, u - first_u, n_u)
            scale[q : q + body.n_q], on_earth = body.scales
            scale[n_q + u : n_q + u + body.n_u] = on_earth * math.sqrt(acceleration / EARTH)
            q, u = q + body.n_q, u + body.n_u
    return layouts


def _lay_body(
    system: System, memory: Memory, blocks: Heap, number: int, is_tied: bool, fields: dict[str, int]
) -> tuple[int, ...]:
    """Write body ``number``, which also reserves its output block; the result has the places of its frames.

    ``is_tied`` is True if it has a joint or a load. ``fields`` are those of the record so far, the numbers of its first
    coordinate and velocity; the others are added to them.
    """
    body = system.bodies[number]
    gravity = dict(zip(("gravity_x", "gravity_y", "gravity_z"), system.gravity, strict=True))
    available = {**body.parameters(), **gravity}
    # arguments t, q and u of the trial
    start: Sequence[float | Sequence[float]] = (0.0, *map(tuple, system.start(body)))
    width, n = FRAME + 6 * body.n_u, body.n_q + body.n_u
    # behind the frames are q', force, inverse mass and two energies
    n_of_frames = len(body.frames) * width
    fields |= _function(blocks, body.evaluator, "body", body, available, n_of_frames + n + body.n_u**2 + 2, start)
    out = fields["out"]
    fields |= {"n_q": body.n_q, "n_u": body.n_u, "tail": out + n_of_frames}
    # where quaternion and spin begin among its coordinates and velocities, -1 without one
    fields |= {"quaternion": body.quaternion, "spin": body.spin}
    # the closed form of ballistic motion is without joints and loads
    if body.flight is not None and not is_tied:
        ballistic = _function(blocks, body.flight, "body", body, available, n, start)
        # it writes q and u after a time
        fields |= {f"ballistic_{name}": value for name, value in ballistic.items()}
    write_record(memory, owners.BodyRecord, number, fields)
    return tuple(range(out, out + n_of_frames, width))


def lay_joints(memory: Memory, blocks: Heap, articulations: Sequence[ArticulationLayout], layouts: BodyLayouts) -> None:
    """Write the articulations (groups of bodies tied by joints), and the joints in the order of the articulations.

    Also reserves their matrices and vectors among the blocks: the inverse mass, and those of the rows of the joints,
    the scalar conditions that the joints set.
    """
    joint = 0
    for number, articulation in enumerate(articulations):
        bodies, ties = articulation.bodies, articulation.joints
        layout = layouts[id(bodies[0])]
        n, first, rows = layout.articulation_n_u, joint, 0
        for tie in ties:
            # the rows of its joints follow each other
            rows += _lay_joint(memory, blocks, joint, tie, rows, layouts)
            joint += 1
        fields = {
            "u": layout.u,
            "n_u": n,
            "first_body": articulation.first,
            "n_bodies": len(bodies),
            # without joints the articulation is one body, which writes its inverse mass itself
            "inverse": blocks.block(n * n) if ties else place_of_inverse_mass(memory, articulation.first),
            "first_joint": first,
            "n_joints": len(ties),
            "n_rows": rows,
            "is_driven": any(tie.first.n_u == 0 or tie.second.n_u == 0 for tie in ties),
        }
        fields |= {name: blocks.block(rows * n) for name in ("jacobian", "response", "solved_response")}
        fields["factor"] = blocks.block(rows * rows)
        fields |= {name: blocks.block(rows) for name in ("residual", "rate", "bias", "forces")}
        write_record(memory, owners.Articulation, number, fields)


def place_of_inverse_mass(memory: Memory, body: int) -> int:
    """Place of the inverse mass of a body among the floats. It follows q' and the force, which begin at ``tail``."""
    return int(
        memory[owners.BodyRecord.tail][body] + memory[owners.BodyRecord.n_q][body] + memory[owners.BodyRecord.n_u][body]
    )


def _lay_joint(memory: Memory, blocks: Heap, number: int, tie: Tie, first: int, layouts: BodyLayouts) -> int:
    """Write joint ``number``; the result is the number of its rows, the scalar conditions that it sets.

    ``first`` is the number of its first row in its articulation, the group of bodies tied by joints. The fields of its
    two sides end in ``_a`` and ``_b``.
    """
    joint = tie.component
    assert isinstance(joint, Joint)
    fields = _function(blocks, joint.evaluator, "pair", joint, joint.parameters(), JOINT_ROW * joint.n_rows)
    fields |= {"first_row": first, "n_rows": joint.n_rows}
    for side, body, frame in zip("ab", (tie.first, tie.second), tie.frames, strict=True):
        layout = layouts[id(body)]
        fields |= {f"frame_{side}": layout.frames[frame], f"n_u_{side}": body.n_u, f"column_{side}": layout.column}
    write_record(memory, owners.JointRecord, number, fields)
    return joint.n_rows


def lay_loads(system: System, memory: Memory, blocks: Heap, layouts: BodyLayouts) -> None:
    """Write the loads: functions of two frames that give a force and a moment, as of springs, and their two sides.

    The fields of the sides end in ``_a`` and ``_b``.
    """
    for number, tie in enumerate(system.loads):
        load = tie.component
        assert isinstance(load, Load)
        # arguments of the trial: time and two frames
        fields = _function(blocks, load.evaluator, "load", load, load.parameters(), LOAD, (0.0, *FRAMES))
        fields["depends_on_time"] = load.depends_on_time
        for side, body, frame in zip("ab", (tie.first, tie.second), tie.frames, strict=True):
            layout = layouts[id(body)]
            fields |= {f"frame_{side}": layout.frames[frame], f"body_{side}": layout.number}
        write_record(memory, owners.LoadRecord, number, fields)


def lay_guards(system: System, memory: Memory, blocks: Heap) -> None:
    """Write the guards of the user, functions of t, q and u whose roots are events. They write no block."""
    for number, guard in enumerate(system.guards):
        address, values = bind(guard.value, "guard", guard.parameters(), type(guard).__name__)
        fields = {"function": address, "parameters": blocks.store(values), "ends_the_run": guard.ends_run}
        write_record(memory, owners.OwnGuard, number, fields)
