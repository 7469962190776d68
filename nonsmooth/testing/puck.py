"""A puck that lies, slides, turns or falls on a slab: the smallest system in which a law runs in the engine."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.blocks import (
    FRAME,
    GAP,
    JACOBIAN,
    NORMAL,
    POINT_A,
    POINT_B,
    ROTATION,
    SIDE_A,
    SIDE_B,
    SLIDE_MATRIX,
    SPIN,
    TANGENT,
    TURN_MATRIX,
    VELOCITY,
)
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces import Body, CompliantNormalLaw, ContactKinematics, ImpactLaw, NormalLaw, Shape, TangentialLaw
from nonsmooth.interfaces.body import POSE_LABELS, TWIST_LABELS, NamesAndUnits
from nonsmooth.runs.simulate import simulate
from nonsmooth.solution.solution import Solution
from nonsmooth.system.contact import Contact
from nonsmooth.system.system import System
from nonsmooth.types import Floats

Array = NDArray[np.float64]
Numbers = tuple[float, ...]
_UPRIGHT: Numbers = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
_RATES = FRAME + 36
"""Where the coordinate rates of the puck stand,"""
_FORCE = _RATES + 3
"""its forces,"""
_INVERSE = _FORCE + 6
"""its inverse masses,"""
_ENERGY = _INVERSE + 36
"""and its energies."""
_FINE = 1e-9
"""Tolerances of gap, velocity and time, in units of the puck's length and speed."""


def _evaluate_slab(t: float, q: Floats, u: Floats, out: Floats, axes: Floats) -> None:
    for i in range(9):
        out[ROTATION + i] = axes[i]


def _evaluate_puck(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    axes: Floats,
    mass: float,
    inertia: float,
    push: Floats,
    gravity_z: float,
) -> None:
    for i in range(9):
        out[ROTATION + i] = axes[i]
    for i in range(3):
        out[i] = q[i]
        out[VELOCITY + i], out[SPIN + i] = u[i], u[3 + i]
        out[_RATES + i] = u[i]
        out[_FORCE + i] = push[i]
        out[_INVERSE + 7 * i], out[_INVERSE + 21 + 7 * i] = 1.0 / mass, 1.0 / inertia
    for i in range(6):
        out[JACOBIAN + 7 * i] = 1.0
    out[_FORCE + 2] = push[2] + mass * gravity_z
    energy = 0.0
    for i in range(3):
        energy += 0.5 * mass * u[i] * u[i] + 0.5 * inertia * u[3 + i] * u[3 + i]
    out[_ENERGY] = energy
    out[_ENERGY + 1] = -mass * gravity_z * q[2] - push[0] * q[0] - push[1] * q[1] - push[2] * q[2]


def _evaluate_touch(a: Floats, b: Floats, out: Floats, normal: Floats, tangent: Floats) -> None:
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
    @property
    def length(self) -> float:
        return 0.0


@final
@dataclass(frozen=True)
class _Touch(ContactKinematics):
    """The point of the puck over the plane of the slab, whose normal and tangent are in the slab's frame."""

    pair: ClassVar[tuple[type[Shape], type[Shape]]] = (_Spot, _Spot)
    normal: Numbers = (0.0, 0.0, 1.0)
    tangent: Numbers = (1.0, 0.0, 0.0)

    def parameters(self) -> dict[str, Any]:
        return {"normal": self.normal, "tangent": self.tangent}

    @classmethod
    def between(cls, first: Shape, second: Shape) -> tuple[_Touch, ...]:
        return (cls(),)

    @property
    def evaluator(self) -> Callable[..., None]:
        return _evaluate_touch

    @property
    def features(self) -> tuple[str, ...]:
        return ("puck-slab",)


@final
@dataclass(frozen=True)
class _Slab(Body):
    axes: Numbers = _UPRIGHT

    def parameters(self) -> dict[str, Any]:
        return {"axes": self.axes}

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        return ((_Spot(),),)

    @property
    def q_labels(self) -> NamesAndUnits:
        return ()

    @property
    def u_labels(self) -> NamesAndUnits:
        return ()

    @property
    def quaternion(self) -> int:
        return -1

    @property
    def evaluator(self) -> Callable[..., None]:
        return _evaluate_slab

    @property
    def scales(self) -> tuple[Array, Array]:
        return np.ones(0), np.ones(0)

    @property
    def time_scale(self) -> float:
        return math.inf

    def state(self, **start: Any) -> tuple[Array, Array]:
        return np.zeros(0), np.zeros(0)


@final
@dataclass(frozen=True)
class Puck(Body):
    """A body whose mass centre touches the slab; its moments of inertia are equal, and its axes stay where they are.

    Velocity and angular velocity are in world axes.  That the axes do not turn disturbs no law but one that has an
    axis fixed to the puck, and such a one is looked at without spin.

    Attributes
    ----------
    mass, inertia : float
        [kg], [kg m^2].
    push : tuple of float
        A constant force [N].
    axes : tuple of float
        Its axes in the world as columns, row by row.
    length, speed : float
        Sizes of its motion [m], [m/s].
    """

    mass: float = 1.0
    inertia: float = 1.0
    push: Numbers = (0.0, 0.0, 0.0)
    axes: Numbers = _UPRIGHT
    length: float = 1.0
    speed: float = 1.0

    def parameters(self) -> dict[str, Any]:
        """Return mass, inertia, push and axes."""
        return {"mass": self.mass, "inertia": self.inertia, "push": self.push, "axes": self.axes}

    @property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """One, with the point that touches."""
        return ((_Spot(),),)

    @property
    def q_labels(self) -> NamesAndUnits:
        """Its position."""
        return POSE_LABELS[:3]

    @property
    def u_labels(self) -> NamesAndUnits:
        """Velocity and angular velocity."""
        return TWIST_LABELS

    @property
    def quaternion(self) -> int:
        """None."""
        return -1

    @property
    def evaluator(self) -> Callable[..., None]:
        """The equations of Newton and Euler."""
        return _evaluate_puck

    @property
    def scales(self) -> tuple[Array, Array]:
        """Those given; angular velocities by the speed and the radius of gyration."""
        spin = self.speed * math.sqrt(self.mass / self.inertia)
        return np.full(3, self.length), np.array([self.speed] * 3 + [spin] * 3)

    @property
    def time_scale(self) -> float:
        """Infinite [s]: nothing is prescribed."""
        return math.inf

    def state(self, **start: Any) -> tuple[Array, Array]:
        """Return the origin, at rest."""
        return np.zeros(3), np.zeros(6)


def run(
    puck: Puck,
    height: float,
    u: Sequence[float] | Array,
    laws: tuple[NormalLaw, TangentialLaw, ImpactLaw | None],
    t_end: float,
    *,
    gravity: float = 0.0,
    slab: Numbers = _UPRIGHT,
) -> Solution:
    """Let a puck start over the slab, and run.

    Parameters
    ----------
    t_end : float
        When the run ends [s].
    puck, height, u, laws, gravity, slab
        Those of :func:`over_slab`.
    """
    engine = EventDriven(
        gap_tolerance=min(1e-12, _FINE * puck.length),
        velocity_tolerance=min(2e-8, _FINE * puck.speed),
        time_tolerance=min(1e-12, _FINE * puck.length / puck.speed),
    )
    system = over_slab(puck, height, u, laws, gravity=gravity, slab=slab)
    return simulate(system, t_end, sample_interval=t_end, engine=engine)


def over_slab(
    puck: Puck,
    height: float,
    u: Sequence[float] | Array,
    laws: tuple[NormalLaw, TangentialLaw, ImpactLaw | None],
    *,
    gravity: float = 0.0,
    slab: Numbers = _UPRIGHT,
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
    laws : tuple
        Normal, tangential and impact law.
    gravity : float
        Along -z [m/s^2].
    slab : tuple of float
        Axes of the slab in the world as columns, row by row.
    """
    base = _Slab(slab)
    system = System([base, puck], gravity)
    rows = np.reshape(slab, (3, 3))
    touch = _Touch(tuple(rows[2].tolist()), tuple(rows[0].tolist()))
    # not by System.contact, which looks for kinematics among those installed
    spots, reaches = (_Spot(), _Spot()), (math.inf, 0.0)
    system._contacts.append(
        Contact("contact of puck and slab", base, puck, (0, 0), spots, touch, reaches, reaches, *laws)
    )
    system.set_start(puck, np.array([0.0, 0.0, height]), np.array(u, dtype=float))
    return system


def _level(indentation: float, rate: float, closing_rate: float, load: float) -> float:
    return load


@final
@dataclass(frozen=True)
class Cushion(CompliantNormalLaw):
    """A normal law whose force is the same at any indentation, so that a load can be given to a law of traction.

    Attributes
    ----------
    load : float
        The force [N].
    """

    load: float = 1.0

    def parameters(self) -> dict[str, Any]:
        """Return the load."""
        return {"load": self.load}

    @property
    def force(self) -> Callable[..., float]:
        """The load."""
        return _level

    @property
    def reach(self) -> float:
        """None."""
        return 0.0

    def is_fulfilled(
        self, indentation: float, rate: float, closing_rate: float, force: float, tolerance: float
    ) -> bool:
        """Tell whether the force is the load."""
        return abs(force - self.load) <= tolerance
