"""Joint forces: what the joints bear over time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.datasets import Told, dataset
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import AXIS, JOINT_ROW, MOMENT, POINT_B
from nonsmooth.histories.arrays import Floats
from nonsmooth.histories.times import of_one, read_times, spoken
from nonsmooth.histories.visitor import visitor
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.laying import articulations

if TYPE_CHECKING:
    import xarray

    from nonsmooth.solution.solution import Solution

_TOLD: Told = {
    "point": (("joint", "axis"), "m", "where the joint holds the second body"),
    "force": (("joint", "axis"), "N", "force on the second body"),
    "moment": (("joint", "axis"), "N m", "moment on the second body about the point"),
}


@final
@dataclass(frozen=True, eq=False)
class JointForces:
    """What every joint, in the order of ``system.joints``, does to its second body; the first bears the opposite.

    Joints are those of ``System.joint``: what a mechanism of generalised coordinates bears inside is never solved for.
    World axes; of a single time the arrays lack the axis n.  Of rows that say the same twice one bears all.

    Attributes
    ----------
    time : array
        [s], shape [n].
    point : array
        Where the joint holds the second body [m]; the origin of its frame if it holds angles only; shape
        [n, n_joints, 3].
    force : array
        [N], shape [n, n_joints, 3].
    moment : array
        About the point [N m], shape [n, n_joints, 3].
    joints : tuple of str
        Names of the joints.
    """

    time: Floats
    point: Floats
    force: Floats
    moment: Floats
    joints: tuple[str, ...]

    def __repr__(self) -> str:
        """Return of which times it is, and how much there is of it."""
        return f"JointForces({spoken(self.time)}; {self.force.shape[-2]} joints)"

    def to_xarray(self) -> xarray.Dataset:
        """Return them as a dataset with names and units."""
        return dataset(self, self.time, _TOLD, {"joint": self.joints})

    @classmethod
    def of(cls, solution: Solution, times: ArrayLike | None = None) -> JointForces:
        """Return the joint forces of a run (:meth:`nonsmooth.Solution.joint_forces`)."""
        given = read_times("Solution.joint_forces", solution, times)
        row, known = np.atleast_1d(given), visitor(solution)
        joints = _joints(known.laid)
        table = np.zeros((3, len(row), len(joints), 3))

        def keep(i: int) -> None:
            for j, joint in enumerate(joints):
                table[:, i, j] = joint.look()

        known.visit(row, keep)
        point, force, moment = table
        found = cls(row, point, force, moment, solution.system.names.joints)
        return found if given.ndim else of_one(found)


@final
@dataclass(frozen=True)
class _Joint:
    """Views of the frame of its second body, of its rows, and of the forces along these."""

    origin: Floats
    rows: Floats
    along: Floats

    def look(self) -> tuple[Floats, Floats, Floats]:
        """Return point, force and moment."""
        axes, moments, points = (self.rows[:, at : at + 3] for at in (AXIS, MOMENT, POINT_B))
        # a row of angles has no axis, and no point
        holding = np.flatnonzero(np.any(axes != 0.0, axis=1))
        point = points[holding[0]] if len(holding) > 0 else self.origin
        return point, self.along @ axes, self.along @ (moments + np.cross(points - point, axes))


def _joints(laid: LaidOut) -> list[_Joint]:
    """Return the joints in the order of the system; the engine has them articulation by articulation."""
    memory, floats, joint = laid.memory, laid.memory.floats, owners.Joint
    found: dict[int, _Joint] = {}
    number = 0
    for index, articulation in enumerate(articulations(laid.system)):
        along = int(memory[owners.Articulation.forces][index])
        for tie in articulation.joints:
            origin, out, first, n = (
                int(memory[one][number]) for one in (joint.frame_b, joint.out, joint.first_row, joint.n_rows)
            )
            rows = floats[out : out + JOINT_ROW * n].reshape(n, JOINT_ROW)
            found[id(tie)] = _Joint(floats[origin : origin + 3], rows, floats[along + first : along + first + n])
            number += 1
    return [found[id(tie)] for tie in laid.system.joints]
