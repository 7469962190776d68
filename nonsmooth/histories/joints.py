"""Joints over time: forces and moments that the joints transmit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import AXIS, JOINT_ROW, MOMENT, POINT_B
from nonsmooth.histories.arrays import Floats
from nonsmooth.histories.request import Request
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.laying import articulations


@final
@dataclass(frozen=True)
class Joints:
    """Forces and moments of joints on their second bodies, in world axes.

    The joints are those of ``System.joint``.  Forces inside a mechanism of generalised coordinates are never solved
    for.  Of redundant rows of a joint, one has the whole force.

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
    def of(cls, request: Request) -> Joints:
        """Solve for the forces at the times of a request."""
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
    """Views of the frame of the second body of a joint, of the rows of the joint, and of the forces along them."""

    origin: Floats
    rows: Floats
    along: Floats

    def __call__(self) -> tuple[Floats, Floats, Floats]:
        """Point, force and moment."""
        axes, moments, points = (self.rows[:, at : at + 3] for at in (AXIS, MOMENT, POINT_B))
        # a row of angles has neither axis nor point
        holding = np.flatnonzero(np.any(axes != 0.0, axis=1))
        point = points[holding[0]] if len(holding) > 0 else self.origin
        return point, self.along @ axes, self.along @ (moments + np.cross(points - point, axes))


def _readers(laid: LaidOut) -> list[_JointReader]:
    """Readers of the joints in the order of the system; the engine has them articulation by articulation."""
    memory, floats, joint = laid.memory, laid.memory.floats, owners.Joint
    found: dict[int, _JointReader] = {}
    number = 0
    for index, articulation in enumerate(articulations(laid.system)):
        along = int(memory[owners.Articulation.forces][index])
        for tie in articulation.joints:
            origin, out, first, n = (
                int(memory[one][number]) for one in (joint.frame_b, joint.out, joint.first_row, joint.n_rows)
            )
            rows = floats[out : out + JOINT_ROW * n].reshape(n, JOINT_ROW)
            found[id(tie)] = _JointReader(floats[origin : origin + 3], rows, floats[along + first : along + first + n])
            number += 1
    return [found[id(tie)] for tie in laid.system.joints]
