"""Quantities of a run at given times, without contact forces: states, modes, frames, energies, joint forces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import AXIS, FRAME, JOINT_ROW, MOMENT, POINT_B, POSITION, ROTATION, SPIN, VELOCITY
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.histories.arrays import Floats, Integers
from nonsmooth.histories.replay import check_recorded
from nonsmooth.histories.request import HistoryRequest
from nonsmooth.model.laid_out import LaidOut, energies
from nonsmooth.model.laying import articulations
from nonsmooth.queries.places import BodyFrames


@final
@dataclass(frozen=True)
class States:
    """Coordinates, velocities and inner states of laws.

    Attributes
    ----------
    q, u : array
        Coordinates and velocities of the bodies, shapes [n, n_q] and [n, n_u].
    law_state : array
        Inner states of friction and traction laws, contact by contact, shape [n, n_states]; the states of an open
        contact are left over from its last closing.
    """

    q: Floats
    u: Floats
    law_state: Floats

    @classmethod
    def of(cls, request: HistoryRequest) -> States:
        """Read the states at the times of a request."""
        solution = request.solution
        sizes = np.cumsum([solution.q.shape[1], solution.u.shape[1], N_ACCOUNTS])
        q, u, _, law_state = np.split(request.y, sizes, axis=1)
        return cls(q[:, request.columns("n_q")], u[:, request.columns("n_u")], law_state)


@final
@dataclass(frozen=True)
class Modes:
    """Modes of contacts at given times; at the time of an event, the modes after it.

    Attributes
    ----------
    request : HistoryRequest
        Run, times and contacts.
    """

    request: HistoryRequest

    @classmethod
    def of(cls, request: HistoryRequest) -> Modes:
        """Modes at the times of a request.

        Raises
        ------
        InvalidInput
            The engine of the run records no modes.
        """
        check_recorded("Solution.history", "modes", request.solution.system, request.solution.recorded.engine)
        return cls(request)

    @property
    def mode(self) -> Integers:
        """Modes of the contacts, 0 open, 1 stick, 2 slide; shape [n, n_contacts]."""
        return self.request.replay.modes(self.request.times)[:, self.request.contacts]

    @property
    def mode_word(self) -> NDArray[Any]:
        """Mode word of all contacts, such as "{01,00,01}", after the last event at or before each time, shape [n].

        Its groups are the bits closed, approaching and slipping, Eq. (29) of the paper.
        """
        codes = self.request.replay.codes(self.request.times)
        return np.array(self.request.solution.events.spelled(codes), dtype=str)


@final
@dataclass(frozen=True)
class Frames:
    """Motion of the frames of bodies, body by body, in world axes.

    Attributes
    ----------
    motion : array
        Position, axes, velocities and further numbers of the motion of each frame, in the order of
        :mod:`nonsmooth.engine.memory.blocks`, shape [n, n_frames, 24].
    """

    motion: Floats

    @classmethod
    def of(cls, request: HistoryRequest) -> Frames:
        """Evaluate the bodies of a request at its times."""
        solution, bodies = request.solution, request.bodies
        n_q = solution.q.shape[1]
        q, u = request.y[:, request.columns("n_q")], request.y[:, n_q + request.columns("n_u")]
        parts, i_q, i_u = [np.zeros((len(request.times), 0, FRAME))], 0, 0
        for body in bodies:
            frames = BodyFrames(body, solution.system.gravity)
            own = q[:, i_q : i_q + body.n_q], u[:, i_u : i_u + body.n_u]
            rows = [frames.motion(t, *row) for t, *row in zip(request.times.tolist(), *own, strict=True)]
            parts.append(np.array(rows).reshape(len(rows), len(body.frames), -1))
            i_q, i_u = i_q + body.n_q, i_u + body.n_u
        return cls(np.concatenate(parts, axis=1))

    def part(self, first: int) -> Floats:
        """Vector in columns ``first`` to ``first + 2`` of each frame, such as its position; shape [n, n_frames, 3]."""
        return self.motion[:, :, first : first + 3]

    @property
    def position(self) -> Floats:
        """Origins of the frames [m], shape [n, n_frames, 3]."""
        return self.part(POSITION)

    @property
    def rotation(self) -> Floats:
        """Axes of the frames as columns, shape [n, n_frames, 3, 3]."""
        return self.motion[:, :, ROTATION : ROTATION + 9].reshape(*self.motion.shape[:2], 3, 3)

    @property
    def velocity(self) -> Floats:
        """Velocities of the origins [m/s], shape [n, n_frames, 3]."""
        return self.part(VELOCITY)

    @property
    def angular_velocity(self) -> Floats:
        """Angular velocities of the frames [rad/s], shape [n, n_frames, 3]."""
        return self.part(SPIN)


@final
@dataclass(frozen=True)
class Energies:
    """Energies of the free bodies, works and losses since the start of the account [J], and rates of coordinates.

    Attributes
    ----------
    kinetic_energy, potential_energy, driven_work, load_work, restitution_loss, friction_loss, closing_loss : array
        As of :class:`nonsmooth.solution.energy.EnergyAccount` [J], shape [n].
    start : float
        Kinetic and potential energy at the start of the account [J].
    coordinate_rate : array
        dq/dt of the bodies, shape [n, n_q].
    """

    kinetic_energy: Floats
    potential_energy: Floats
    driven_work: Floats
    load_work: Floats
    restitution_loss: Floats
    friction_loss: Floats
    closing_loss: Floats
    start: float
    coordinate_rate: Floats

    @classmethod
    def of(cls, request: HistoryRequest) -> Energies:
        """Compute energies, works and losses at the times of a request.

        Each state is visited once, and all of these quantities are computed from it.
        """
        laid, account = request.replay.laid, request.solution.energy
        memory, bodies, first = laid.memory, laid.system.bodies, laid.n_q + laid.n_u
        y, tails, totals = memory[owners.Island.y], memory[owners.BodyRecord.tail][: len(bodies)], owners.Totals
        table, rates = np.zeros((7, len(request.times))), np.zeros((len(request.times), laid.n_q))
        # the tail of a body's block is the part after its frames, and begins with dq/dt
        places = np.concatenate(
            [np.zeros(0, np.int64), *(tail + np.arange(body.n_q) for tail, body in zip(tails, bodies, strict=True))]
        )

        def keep(i: int) -> None:
            driven, dissipated, _, loads, closed = y[first : first + N_ACCOUNTS]
            call_entry("evaluate_free_bodies", memory, memory[owners.Island.time], memory.start(owners.Island.y), 1)
            table[:2, i] = energies(bodies, tails, memory.floats)
            table[2:4, i] = memory[totals.driven_work] + driven, loads
            losses = memory[totals.restitution_loss], memory[totals.friction_loss] + dissipated
            table[4:, i] = *losses, memory[totals.closing_loss] + closed
            rates[i] = memory.floats[places]

        request.replay.visit(request.times, keep, forces=False)
        start = account.kinetic_start + account.potential_start
        kinetic, potential, driven, loads, *losses = table
        restitution, friction, closing = losses
        rates = rates[:, request.columns("n_q")]
        return cls(kinetic, potential, driven, loads, restitution, friction, closing, start, rates)

    @property
    def loss(self) -> Floats:
        """Sum of the losses by restitution, friction and closing steps since the start of the account [J], shape [n].

        A closing step ends an accumulation of impacts.
        """
        return self.restitution_loss + self.friction_loss + self.closing_loss

    @property
    def unexplained_energy(self) -> Floats:
        """Change of kinetic and potential energy that no work and no loss explains [J], shape [n]."""
        change = self.kinetic_energy + self.potential_energy - self.start
        return change - self.driven_work - self.load_work + self.loss


@final
@dataclass(frozen=True)
class Joints:
    """Forces and moments of joints on their second bodies, in world axes.

    The joints are those of ``System.joint``.  Forces inside a mechanism of generalised coordinates are not computed.
    If rows of a joint are redundant, one of them has the whole force.

    Attributes
    ----------
    joint_point : array
        Point at which the joint holds the second body [m]; the origin of its frame for a joint that holds angles only;
        shape [n, n_joints, 3].
    joint_force : array
        Force [N], shape [n, n_joints, 3].
    joint_moment : array
        Moment about the point [N m], shape [n, n_joints, 3].
    """

    joint_point: Floats
    joint_force: Floats
    joint_moment: Floats

    @classmethod
    def of(cls, request: HistoryRequest) -> Joints:
        """Compute the joint forces at the times of a request; the engine solves the equations of motion for them."""
        joints = _readers(request.replay.laid)
        chosen = [joints[number] for number in request.numbers("joint")]
        table = np.zeros((3, len(request.times), len(chosen), 3))

        def keep(i: int) -> None:
            for j, joint in enumerate(chosen):
                table[:, i, j] = joint()

        request.replay.visit(request.times, keep)
        return cls(*table)


@final
@dataclass(frozen=True)
class _JointReader:
    """Reader of one joint: offsets of its second body's frame, its rows (constraints) and the forces along the rows."""

    memory: Memory
    origin: int
    rows: int
    along: int
    n_rows: int

    def __call__(self) -> tuple[Floats, Floats, Floats]:
        """Point of action of the joint [m], and its force [N] and moment about this point [N m] on the second body.

        All of them are in world axes, shape [3] each.
        """
        floats = self.memory.floats
        rows = floats[self.rows :][: JOINT_ROW * self.n_rows].reshape(self.n_rows, JOINT_ROW)
        along, origin = floats[self.along :][: self.n_rows], floats[self.origin :][:3]
        axes, moments, points = (rows[:, at : at + 3] for at in (AXIS, MOMENT, POINT_B))
        # a row that constrains a rotation has a zero axis and no point of action. So the point of the first row that
        # constrains a translation is used
        holding = np.flatnonzero(np.any(axes != 0.0, axis=1))
        point = points[holding[0]] if len(holding) > 0 else origin
        return point, along @ axes, along @ (moments + np.cross(points - point, axes))


def _readers(laid: LaidOut) -> list[_JointReader]:
    """Readers of the joints in the order of the system; the engine stores them articulation by articulation."""
    memory, joint = laid.memory, owners.JointRecord
    found: dict[int, _JointReader] = {}
    number = 0
    for index, articulation in enumerate(articulations(laid.system)):
        along = int(memory[owners.Articulation.forces][index])
        for tie in articulation.joints:
            origin, out, first, n = (
                int(memory[one][number]) for one in (joint.frame_b, joint.out, joint.first_row, joint.n_rows)
            )
            found[id(tie)] = _JointReader(memory, origin, out, along + first, n)
            number += 1
    return [found[id(tie)] for tie in laid.system.joints]
