"""Systems that can be built moved, turned, mirrored and renumbered; their runs are told as if nothing had been done."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import Rest
from nonsmooth.interfaces import Body, Joint

Array = NDArray[np.float64]
Start = dict[str, Any]
_MIRROR = np.array([1.0, -1.0, 1.0])


@dataclass(frozen=True)
class Move:
    """A mirror image (y to -y) first, then a turn, then a shift [m]."""

    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0)
    mirror: bool = False

    @property
    def _rotation(self) -> Rotation:
        return Rotation.from_rotvec(self.turn)

    def inside(self, local: Sequence[float]) -> Any:
        """Return a point or an axis of a body in the body's own axes."""
        return tuple((np.asarray(local) * (_MIRROR if self.mirror else 1.0)).tolist())

    def spin(self, local: Sequence[float]) -> Any:
        """Return an angular velocity in the body's own axes: no vector to a mirror."""
        return tuple((np.asarray(local) * (-_MIRROR if self.mirror else 1.0)).tolist())

    def vector(self, value: Sequence[float]) -> Array:
        """Return a vector of the world."""
        return np.asarray(self._rotation.apply(self.inside(value)))

    def point(self, value: Sequence[float]) -> Array:
        """Return a point of the world."""
        return self.vector(value) + self.shift

    def orientation(self, quaternion: Sequence[float]) -> Array:
        """Return an orientation, scalar first."""
        s, *axis = quaternion
        seen = self._rotation * Rotation.from_quat([*self.spin(axis), s])
        return np.roll(seen.as_quat(), 1)

    def back(self, position: Array, matrix: Array, velocity: Array) -> tuple[Array, Array, Array]:
        """Return position, rotation matrix and velocity as they were before the move."""
        sides = np.diag(_MIRROR if self.mirror else np.ones(3))
        turned = self._rotation.inv()
        return (
            sides @ turned.apply(position - self.shift),
            sides @ turned.as_matrix() @ matrix @ sides,
            sides @ turned.apply(velocity),
        )

    def rest(self, position: Sequence[float] = (0.0, 0.0, 0.0), orientation: Sequence[float] = (1.0, 0, 0, 0)) -> Rest:
        """Return a rest at a pose of the world."""
        pose: Any = tuple(self.point(position).tolist()), tuple(self.orientation(orientation).tolist())
        return Rest(position=pose[0], orientation=pose[1])


@dataclass(frozen=True)
class Order:
    """Seeds of the numbering: 0 is the order given; also which of two bodies comes first in a contact."""

    seed: int = 0

    def of(self, n: int, salt: int) -> list[int]:
        """Return a permutation of n things."""
        return np.random.default_rng([self.seed, salt]).permutation(n).tolist() if self.seed else list(range(n))

    def swaps(self, n: int) -> list[bool]:
        """Return whom to turn round."""
        return (np.random.default_rng([self.seed, 9]).random(n) < 0.5).tolist() if self.seed else [False] * n


Part = tuple[Callable[[Move], Body], Start | None]


def free(start: Start, kind: Callable[..., Body], *sizes: Any) -> Part:
    """Return a free body with its start, for a :class:`Cast`."""
    return (lambda move: kind(*sizes)), start


@dataclass(frozen=True)
class Cast:
    """What a system is made of.

    Attributes
    ----------
    bodies : tuple
        (function of a Move that makes the body, its start), start None for a driven one.
    contacts : tuple
        (number of the first body, number of the second, laws).
    joints : tuple
        (function of a Move that makes the joint, number of the first body, number of the second).
    gravity, t_end, length, speed : float
        Gravity [m/s^2], end [s], and the scales that errors are relative to [m], [m/s].
    """

    bodies: tuple[Part, ...]
    contacts: tuple[tuple[int, int, dict[str, Any]], ...]
    t_end: float
    length: float
    speed: float
    gravity: float = 0.0
    joints: tuple[tuple[Callable[[Move], Joint], int, int], ...] = ()
    engine: ns.EventDriven = field(default_factory=lambda: ns.EventDriven(tolerance=1e-12, impact_tolerance=1e-12))

    def run(self, move: Move = Move(), order: Order = Order()) -> tuple[Array, Array, list[str], int]:
        """Return final state and times of events, both without units, sorted causes, and the number of impacts."""
        bodies = [make(move) for make, _ in self.bodies]
        system = ns.System([bodies[i] for i in order.of(len(bodies), 1)], self.gravity)
        swaps = order.swaps(len(self.contacts))
        for i in order.of(len(self.contacts), 2):
            first, second, laws = self.contacts[i]
            pair = (bodies[second], bodies[first]) if swaps[i] else (bodies[first], bodies[second])
            system.contact(*pair, **laws)
        for i in order.of(len(self.joints), 3):
            make, first, second = self.joints[i]
            system.joint(make(move), bodies[first], bodies[second])
        for body, (_, start) in zip(bodies, self.bodies, strict=True):
            if start is not None:
                words = {
                    "position": move.point(start["position"]),
                    "orientation": move.orientation(start.get("orientation", (1.0, 0.0, 0.0, 0.0))),
                    "velocity": move.vector(start.get("velocity", (0.0, 0.0, 0.0))),
                    "angular_velocity": move.spin(start.get("angular_velocity", (0.0, 0.0, 0.0))),
                }
                system.place(body, **words)
        solution = ns.simulate(system, self.t_end, sample_interval=self.t_end, engine=self.engine)
        parts = []
        for body, (_, start) in zip(bodies, self.bodies, strict=True):
            if start is not None:
                q, u = solution.history("q", "u", times=solution.t_end, of=body).values()
                matrix = Rotation.from_quat(np.roll(q[3:], -1)).as_matrix()
                x, matrix, v = move.back(q[:3], matrix, u[:3])
                spin = np.asarray(move.spin(u[3:].tolist()))
                parts += [x / self.length, matrix.ravel(), v / self.speed, spin * self.length / self.speed]
        times = solution.events.time / self.t_end
        return np.concatenate(parts), times, sorted(solution.events.causes()), solution.counters.impacts


def quaternion(axis: Sequence[float], angle: float) -> tuple[float, float, float, float]:
    """Return a unit quaternion, scalar first."""
    part = np.asarray(axis, dtype=float) * math.sin(0.5 * angle) / np.linalg.norm(axis)
    return math.cos(0.5 * angle), *part.tolist()
