"""Two free bodies that can be put anywhere, and what the engine makes of a contact between them."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import FRAME, JACOBIAN, PAIR, ROTATION, SPIN, VELOCITY
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces import Body, ContactKinematics, Shape
from nonsmooth.interfaces.body import POSE_LABELS, TWIST_LABELS, NamesAndUnits
from nonsmooth.model.assembly import lay_out
from nonsmooth.system.contact import Contact
from nonsmooth.system.system import System
from nonsmooth.testing.reference import Constant, Rigid, Spring
from nonsmooth.types import Floats

Array = NDArray[np.float64]
Pose = tuple[Array, Array]
"""Position [m] and unit quaternion, scalar first."""


def _evaluate(t: float, q: Floats, u: Floats, out: Floats) -> None:
    a, b, c, d = q[3], q[4], q[5], q[6]
    r = ROTATION
    out[r], out[r + 1], out[r + 2] = a * a + b * b - c * c - d * d, 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)
    out[r + 3], out[r + 4], out[r + 5] = 2.0 * (b * c + a * d), a * a - b * b + c * c - d * d, 2.0 * (c * d - a * b)
    out[r + 6], out[r + 7], out[r + 8] = 2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d
    for i in range(3):
        out[i] = q[i]
        out[VELOCITY + i], out[SPIN + i] = u[i], u[3 + i]
    for i in range(6):
        out[JACOBIAN + 7 * i] = 1.0
        # behind Jacobian 36, coordinate rates 7 and force 6
        out[FRAME + 49 + 7 * i] = 1.0


@final
@dataclass(frozen=True)
class _Carrier(Body):
    """A body of unit mass and moments; velocities in world axes, and no coordinate rates: it stays where it is put."""

    shape: Shape

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        return ((self.shape,),)

    @property
    def q_labels(self) -> NamesAndUnits:
        return POSE_LABELS

    @property
    def u_labels(self) -> NamesAndUnits:
        return TWIST_LABELS

    @property
    def quaternion(self) -> int:
        return 3

    @property
    def evaluator(self) -> Callable[..., None]:
        return _evaluate

    @property
    def scales(self) -> tuple[Array, Array]:
        return np.ones(7), np.ones(6)

    @property
    def time_scale(self) -> float:
        return math.inf

    def state(self, **start: Any) -> tuple[Array, Array]:
        return np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]), np.zeros(6)


class Rig:
    """Two bodies with a shape each and one contact."""

    def __init__(self, kinematics: ContactKinematics, shapes: tuple[Shape, Shape]) -> None:
        self._bodies = _Carrier(shapes[0]), _Carrier(shapes[1])
        system = System(self._bodies)
        extents = shapes[0].extent, shapes[1].extent
        levers = shapes[0].lever, shapes[1].lever
        name = type(kinematics).__name__
        # not by System.contact, which looks for kinematics among those installed
        system._contacts.append(
            Contact(name, *self._bodies, (0, 0), shapes, kinematics, extents, levers, Rigid(), Constant(), Spring())
        )
        self._model = lay_out(system, EventDriven())

    def put(self, poses: Sequence[Pose], u: Array) -> None:
        """Put the bodies somewhere, with velocities and angular velocities in world axes, shape [12]."""
        q = np.concatenate([np.concatenate(pose) for pose in poses])
        self._model.memory[owners.Island.y][:26] = np.concatenate([q, u])
        call_entry("evaluate_at", self._model.memory)

    def _row(self, declared: Any) -> Array:
        return np.array(self._model.memory[declared][0])

    @property
    def geometry(self) -> Array:
        """The geometry block, shape [31]."""
        return self._row(owners.Contact.geometry)[:PAIR]

    @property
    def axes(self) -> Array:
        """Normal and tangents, shape [3, 3]."""
        return self._row(owners.Contact.axes).reshape(3, 3)

    @property
    def rate(self) -> Array:
        """Gap rate and slip velocity [m/s], shape [3]."""
        return self._row(owners.Contact.rate)

    @property
    def bias(self) -> Array:
        """Their derivatives while u' = 0, shape [3]."""
        return self._row(owners.Contact.bias)
