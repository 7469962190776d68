"""Body: coordinates, dynamics and the motion of frames that carry shapes."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces.look import Look
from nonsmooth.interfaces.scales import EARTH
from nonsmooth.interfaces.shape import Shape
from nonsmooth.parameters import Component

Vector = NDArray[np.float64]
NamesAndUnits: TypeAlias = tuple[tuple[str, str], ...]
"""Name and unit of each of some numbers, as in (("x", "m"), ("angle", "rad"))."""
UNITS_OF_Q, UNITS_OF_U = ("m", "rad", "1", "J"), ("m/s", "rad/s", "1/s", "W")
"""Units that coordinates and velocities may have; a coordinate in [J] is a work that a body integrates."""
POSE_LABELS: NamesAndUnits = tuple(zip(("x", "y", "z", "q0", "q1", "q2", "q3"), "mmm1111", strict=True))
TWIST_LABELS: NamesAndUnits = tuple(zip(("vx", "vy", "vz", "wx", "wy", "wz"), 3 * ["m/s"] + 3 * ["rad/s"], strict=True))
"""Names and units of a free body's velocities: velocity [m/s], then angular velocity [rad/s]."""


class Body(Component, ABC):
    """One body of a system.

    The contract:

    1. ``evaluator`` is a plain function ``evaluate(t, q, u, out, ...)`` that writes the body's output
       block (:mod:`nonsmooth.engine.memory.blocks`) at time t [s], coordinates q, velocities u; parts that are
       zero need not be written.  Its further arguments are names out of ``parameters()`` and of the
       surroundings (gravity_x, gravity_y, gravity_z [m/s^2]).
    2. M du/dt = h + contact forces, dq/dt = B(q) u; the Jacobian maps u to the velocity of the frame
       origin and its angular velocity, both in world axes.
    3. A driven body has no coordinates and writes the motion of its frames only.
    4. ``flight``, if a closed form is known, is a plain function ``fly(t, q, u, out, ...)`` with further arguments of
       the same kinds.  It writes q, and behind it u, after a time t [s] of free motion, in which h alone acts and does
       not change with time.  The engine then integrates the body only while something touches or holds it.
    5. ``state`` turns the keywords of a start into q and u, or raises InvalidInput.
    """

    @property
    @abstractmethod
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """The shapes that each frame carries."""

    @property
    def sketch(self) -> tuple[Look, ...]:
        """Visible parts of each frame other than its shapes, such as a rod without contacts; none by default."""
        return ()

    def strokes(self, q: Vector) -> Vector:
        """Return the ends of n lines that show the body at coordinates ``q`` [m], shape [n, 2, 3]; n = 0 by default.

        The points are in world axes.  The lines show parts without a frame, such as the links of a mechanism.  The
        number n must not depend on ``q``.
        """
        return np.zeros((0, 2, 3))

    @property
    def q_labels(self) -> NamesAndUnits:
        """Name and unit of every coordinate; empty by default, for a driven body. The unit of a quaternion is "1"."""
        return ()

    @property
    def u_labels(self) -> NamesAndUnits:
        """Name and unit of every velocity; empty by default, for a driven body."""
        return ()

    @property
    def n_q(self) -> int:
        """Number of coordinates."""
        return len(self.q_labels)

    @property
    def n_u(self) -> int:
        """Number of velocities."""
        return len(self.u_labels)

    @property
    def quaternion(self) -> int:
        """Offset of the unit quaternion in q; -1, the default, if there is no quaternion."""
        return -1

    @property
    def spin(self) -> int:
        """Offset in u of an angular velocity in body axes that the engine integrates in space axes; -1 if none.

        The quaternion's rate must be half the product of the quaternion and this angular velocity.  The reason is fast
        symmetric tops: in body axes a force on the top turns as fast as the top spins.  In space axes the force and the
        angular velocity change slowly.
        """
        return -1

    @property
    @abstractmethod
    def evaluator(self) -> Callable[..., None]:
        """Plain function ``evaluate(t, q, u, out, ...)`` that writes the body's output block: point 1 above."""

    @property
    def flight(self) -> Callable[..., None] | None:
        """Plain function ``fly(t, q, u, out, ...)`` of free motion in closed form: point 4 above; None by default."""
        return None

    @property
    def length_scale(self) -> float:
        """Size of the body [m]; by default the distance of the farthest point of its shapes, or 1 m without shapes."""
        return max((shape.length for frame in self.frames for shape in frame), default=0.0) or 1.0

    @property
    def scales(self) -> tuple[Vector, Vector]:
        """Sizes of q and u below which the tolerance of a step is absolute, not relative; shapes [n_q] and [n_u].

        By default each size follows from the unit: :attr:`length_scale` L for m; sqrt(9.81 L), about the speed of a
        fall through L, for m/s; this speed divided by L for rad/s; 1 for every other unit, such as rad or 1.  In a
        system whose typical acceleration a is smaller, the sizes of u are those of here times sqrt(a / 9.81).
        """
        length = self.length_scale
        speed = math.sqrt(EARTH * length)
        q, u = {"m": length}, {"m/s": speed, "rad/s": speed / length}
        return (
            np.array([q.get(unit, 1.0) for _, unit in self.q_labels]),
            np.array([u.get(unit, 1.0) for _, unit in self.u_labels]),
        )

    @property
    def time_scale(self) -> float:
        """Shortest time over which prescribed motion changes [s]; infinite, the default, without prescribed motion."""
        return math.inf

    @abstractmethod
    def state(self, **start: Any) -> tuple[Vector, Vector]:
        """Return q and u of a start, shapes [n_q] and [n_u].

        Raises
        ------
        InvalidInput
            If a keyword is unknown, a shape is wrong, a number is not finite, or a quaternion has no unit length.
        """
