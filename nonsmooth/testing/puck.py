"""A puck that slides, turns or falls on a slab: the smallest system in which a law runs in the engine.

Also a rig: two pucks in any poses, and the geometry of a contact between them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import (
    GAP,
    JACOBIAN,
    NORMAL,
    PAIR,
    POINT_A,
    POINT_B,
    POSITION,
    ROTATION,
    SIDE_A,
    SIDE_B,
    SLIDE_MATRIX,
    SPIN,
    TANGENT,
    TURN_MATRIX,
    VELOCITY,
)
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces import Body, CompliantNormalLaw, FeaturePair, Shape
from nonsmooth.interfaces.body import POSE_LABELS, TWIST_LABELS
from nonsmooth.model.assembly import lay_out
from nonsmooth.parameters import parameter
from nonsmooth.rotations import rotation
from nonsmooth.runs.simulate import simulate
from nonsmooth.solution.solution import Solution
from nonsmooth.system.contact import Contact
from nonsmooth.system.materials import ContactLaws
from nonsmooth.system.system import System
from nonsmooth.testing.reference import ReferenceContact, ReferenceFriction, ReferenceImpact
from nonsmooth.types import Array, Floats

Numbers = tuple[float, ...]
Pose = tuple[Array, Array]
"""Position [m] and unit quaternion, scalar first."""
_UNTURNED = (1.0, 0.0, 0.0, 0.0)
_RATES = JACOBIAN + 36
_FORCE = _RATES + 7
_INVERSE_MASS = _FORCE + 6
_ENERGY = _INVERSE_MASS + 36
"""Offsets of rates, force, inverse mass matrix and energies in the block of a body with 7 coordinates and 6 velocities.
The Jacobian, which precedes the rates, has 36 numbers."""
_FINE = 1e-9
"""Tolerances of gap, velocity and time, in units of the puck's length and speed."""
_STEP = 1e-10
"""Relative tolerance of a step of the engine.

After the force has ended, the puck coasts, and the error of its velocity becomes an error of its position. In the
longest impact, which is overdamped, 1e-9 leaves an error of 1.2e-6 of the depth, and 1e-10 an error of 8e-8. The checks
allow 1e-6.
"""


@compiled
def _write_rotation(out: Floats, a: float, b: float, c: float, d: float) -> None:
    """Write the rotation matrix of a unit quaternion."""
    xx, yy, zz = a * a + b * b - c * c - d * d, a * a - b * b + c * c - d * d, a * a - b * b - c * c + d * d
    out[ROTATION], out[ROTATION + 1], out[ROTATION + 2] = xx, 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)
    out[ROTATION + 3], out[ROTATION + 4], out[ROTATION + 5] = 2.0 * (b * c + a * d), yy, 2.0 * (c * d - a * b)
    out[ROTATION + 6], out[ROTATION + 7], out[ROTATION + 8] = 2.0 * (b * d - a * c), 2.0 * (c * d + a * b), zz


def _evaluate_slab(t: float, q: Floats, u: Floats, out: Floats, turn: Floats) -> None:
    _write_rotation(out, turn[0], turn[1], turn[2], turn[3])


def _evaluate_puck(
    t: float, q: Floats, u: Floats, out: Floats, mass: float, inertia: float, push: Floats, gravity_z: float
) -> None:
    _write_rotation(out, q[3], q[4], q[5], q[6])
    kinetic, potential = 0.0, -mass * gravity_z * q[2]
    for i in range(3):
        out[POSITION + i], out[VELOCITY + i], out[SPIN + i] = q[i], u[i], u[3 + i]
        out[JACOBIAN + 7 * i] = out[JACOBIAN + 21 + 7 * i] = 1.0
        out[_RATES + i], out[_FORCE + i] = u[i], push[i]
        out[_INVERSE_MASS + 7 * i], out[_INVERSE_MASS + 21 + 7 * i] = 1.0 / mass, 1.0 / inertia
        kinetic += 0.5 * (mass * u[i] * u[i] + inertia * u[3 + i] * u[3 + i])
        potential -= push[i] * q[i]
    out[_FORCE + 2] = push[2] + mass * gravity_z
    out[_ENERGY], out[_ENERGY + 1] = kinetic, potential


def _evaluate_touch(a: Floats, b: Floats, out: Floats, normal: Floats, tangent: Floats) -> None:
    """Write the geometry of a contact between a plane and a point.

    The plane passes through the origin of the first body; its normal and tangent are given in the frame of that body.
    """
    gap = 0.0
    for i in range(3):
        n = t = 0.0
        for j in range(3):
            n += a[ROTATION + 3 * i + j] * normal[j]
            t += a[ROTATION + 3 * i + j] * tangent[j]
        out[NORMAL + i], out[TANGENT + i], out[POINT_B + i] = n, t, b[i]
        gap += n * (b[i] - a[i])
    out[GAP] = gap
    for i in range(3):
        out[POINT_A + i] = out[POINT_B + i] - gap * out[NORMAL + i]
    # a plane: slide 0, turn 1; a point: slide 1, turn 0
    out[SIDE_A + TURN_MATRIX] = out[SIDE_A + TURN_MATRIX + 3] = 1.0
    out[SIDE_B + SLIDE_MATRIX] = out[SIDE_B + SLIDE_MATRIX + 3] = 1.0


@final
@dataclass(frozen=True)
class _Spot(Shape):
    """A point at the origin if the length is zero, a plane through the origin if the length is infinite."""

    length: float = 0.0


def _touch(normal: Numbers, tangent: Numbers) -> FeaturePair:
    """The point of the puck over the plane of the slab; normal and tangent are in the slab's frame."""
    return FeaturePair(_evaluate_touch, {"normal": normal, "tangent": tangent}, ("puck-slab",))


@final
@dataclass(frozen=True)
class _Slab(Body):
    """A driven body at rest; ``turn`` is the unit quaternion of its axes."""

    turn: Numbers = _UNTURNED
    frames = ((_Spot(math.inf),),)
    q_labels = u_labels = ()
    quaternion, time_scale = -1, math.inf
    scales = (np.ones(0), np.ones(0))
    evaluator = staticmethod(_evaluate_slab)

    def parameters(self) -> dict[str, Any]:
        return {"turn": self.turn}

    def state(self, **start: Any) -> tuple[Array, Array]:
        return np.zeros(0), np.zeros(0)


@final
@dataclass(frozen=True)
class Puck(Body):
    """A body whose mass centre touches the slab, with equal moments of inertia.

    Velocity and angular velocity are in world axes. The orientation stays constant even if the puck spins. It matters
    only for a law with an axis fixed to the puck, and such a law is checked without spin.

    Attributes
    ----------
    mass, inertia : float
        Mass [kg] and moment of inertia [kg m^2].
    push : tuple of float
        A constant force [N].
    length, speed : float
        Typical length [m] and speed [m/s] of the motion.
    shape : Shape
        The shape that it carries.
    """

    mass: float = 1.0
    inertia: float = 1.0
    push: Numbers = (0.0, 0.0, 0.0)
    length: float = 1.0
    speed: float = 1.0
    shape: Shape = _Spot()
    q_labels, u_labels = POSE_LABELS, TWIST_LABELS
    quaternion, time_scale = 3, math.inf
    evaluator = staticmethod(_evaluate_puck)

    def parameters(self) -> dict[str, Any]:
        """Return mass, inertia and push."""
        return {"mass": self.mass, "inertia": self.inertia, "push": self.push}

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """A single frame with the shape."""
        return ((self.shape,),)

    @property
    def scales(self) -> tuple[Array, Array]:
        """Typical sizes of coordinates and velocities; of angular velocity, the speed over the radius of gyration."""
        spin = self.speed * math.sqrt(self.mass / self.inertia)
        return np.array([self.length] * 3 + [1.0] * 4), np.array([self.speed] * 3 + [spin] * 3)

    def state(self, **start: Any) -> tuple[Array, Array]:
        """Return coordinates and velocities at rest at the origin; all arguments are ignored."""
        return np.array([0.0, 0.0, 0.0, *_UNTURNED]), np.zeros(6)


def run(
    puck: Puck, height: float, u: Sequence[float] | Array, laws: ContactLaws, t_end: float, **place: Any
) -> Solution:
    """Run a puck that starts at a height above the slab; return the solution.

    Parameters
    ----------
    t_end : float
        End time [s].
    puck, height, u, laws, place
        As in :func:`over_slab`.
    """
    engine = EventDriven(
        tolerance=_STEP,
        gap_tolerance=min(1e-12, _FINE * puck.length),
        velocity_tolerance=min(2e-8, _FINE * puck.speed),
        time_tolerance=min(1e-12, _FINE * puck.length / puck.speed),
    )
    return simulate(
        over_slab(puck, height, u, laws, **place), t_end, sample_interval=t_end, engine=engine, progress=None
    )


def over_slab(
    puck: Puck,
    height: float,
    u: Sequence[float] | Array,
    laws: ContactLaws,
    *,
    gravity: float = 0.0,
    turn: Numbers = _UNTURNED,
    slab_turn: Numbers = _UNTURNED,
) -> System:
    """Return a puck over a slab whose normal is the world's z axis.

    Parameters
    ----------
    puck : Puck
        The puck.
    height : float
        Gap at the start [m].
    u : array
        Velocity and angular velocity at the start [m/s, rad/s], shape [6].
    laws : ContactLaws
        The laws of the contact.
    gravity : float
        Gravity along -z [m/s^2].
    turn, slab_turn : tuple of float
        Unit quaternions of the axes of puck and slab.
    """
    slab = _Slab(slab_turn)
    system = System([slab, puck], gravity)
    x, _, z = rotation(slab_turn).tolist()
    shapes, touch = (slab.frames[0][0], puck.shape), _touch(tuple(z), tuple(x))
    system.add_contact(Contact.of_shapes((slab, puck), shapes, touch, laws, name="contact of puck and slab"))
    system.set_start(puck, np.array([0.0, 0.0, height, *turn]), np.array(u, dtype=float))
    return system


def _level(indentation: float, rate: float, closing_rate: float, load: float) -> float:
    return load


@final
@dataclass(frozen=True)
class ConstantLoad(CompliantNormalLaw):
    """A normal law with the same force at any indentation, which loads a contact with a law of traction.

    Attributes
    ----------
    load : float
        The force [N].
    """

    load: float = parameter(1.0, doc="force", unit="N")
    reach = 0.0
    force = staticmethod(_level)

    def is_fulfilled(
        self, indentation: float, rate: float, closing_rate: float, force: float, tolerance: float
    ) -> bool:
        """True if the normal force equals the constant load of the law [N]."""
        return abs(force - self.load) <= tolerance


class ContactRig:
    """Two pucks with one shape each, and a contact between them with given kinematics."""

    def __init__(self, kinematics: FeaturePair, shapes: tuple[Shape, Shape]) -> None:
        bodies = Puck(shape=shapes[0]), Puck(shape=shapes[1])
        system, laws = System(bodies), ContactLaws(ReferenceContact(), ReferenceFriction(), ReferenceImpact())
        system.add_contact(Contact.of_shapes(bodies, shapes, kinematics, laws))
        self._model = lay_out(system, EventDriven())

    def put(self, poses: Sequence[Pose], u: Array) -> None:
        """Give the bodies poses, and velocities with angular velocities in world axes [m/s, rad/s], shape [12]."""
        q = np.concatenate([np.concatenate(pose) for pose in poses])
        self._model.memory[owners.Island.y][:26] = np.concatenate([q, u])
        call_entry("evaluate_at", self._model.memory)

    def _row(self, declared: Any) -> Array:
        return np.array(self._model.memory[declared][0])

    @property
    def geometry(self) -> Array:
        """Geometry block of the contact, shape [31]."""
        return self._row(owners.ContactRecord.geometry)[:PAIR]

    @property
    def axes(self) -> Array:
        """Normal and tangents of the contact as rows, shape [3, 3]."""
        return self._row(owners.ContactRecord.axes).reshape(3, 3)

    @property
    def rate(self) -> Array:
        """Gap rate and slip velocity [m/s], shape [3]."""
        return self._row(owners.ContactRecord.rate)

    @property
    def bias(self) -> Array:
        """Second-order terms of gap and slip, the derivatives of their rates while u' = 0 [m/s^2], shape [3]."""
        return self._row(owners.ContactRecord.bias)
