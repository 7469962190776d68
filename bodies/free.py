"""Free rigid bodies: position and unit quaternion, velocity and body-fixed angular velocity."""

from __future__ import annotations

import functools
import math
from abc import abstractmethod
from collections.abc import Callable, Mapping
from typing import Any, ClassVar, final

import numpy as np

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import JACOBIAN, POSITION, ROTATION, SPIN, VELOCITY
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body, Shape
from nonsmooth.interfaces.body import POSE_LABELS, TWIST_LABELS, Vector
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from .blocks import places_behind_frame, put_rows, rotation_of
from .inertia import Triple, check_inertia, tensor_of
from .values import Word, check_carried, read_start
from .vectors import dot, plus_scaled, scaled, vector_at, write_vector

_WORDS: dict[str, Word] = {
    "position": (3, (0.0, 0.0, 0.0), "m"),
    "orientation": (4, (1.0, 0.0, 0.0, 0.0), "1"),
    "velocity": (3, (0.0, 0.0, 0.0), "m/s"),
    "angular_velocity": (3, (0.0, 0.0, 0.0), "rad/s"),
}
_RATES, _FORCE, _INVERSE, _ENERGY = places_behind_frame(n_q=7, n_u=6)
"""Indices of coordinate rates, force, inverse mass matrix and energies in the output block, in this order."""


def _evaluate(
    t: float,
    q: Floats,
    u: Floats,
    out: Floats,
    mass: float,
    inertia: Floats,
    inverse_inertia: Floats,
    gravity_x: float,
    gravity_y: float,
    gravity_z: float,
) -> None:
    # numbers are read where they are used: more of them at a time would not fit into the registers
    a, b, c, d = q[3], q[4], q[5], q[6]
    ox, oy, oz = spin = vector_at(u, 3)
    write_vector(out, POSITION, vector_at(q, 0))
    write_vector(out, VELOCITY, vector_at(u, 0))
    rows = rotation_of(a, b, c, d)
    put_rows(out, ROTATION, rows)
    write_vector(out, SPIN, (dot(rows[0], spin), dot(rows[1], spin), dot(rows[2], spin)))
    # Jacobian of (velocity, angular velocity): identity and rotation
    out[JACOBIAN] = out[JACOBIAN + 7] = out[JACOBIAN + 14] = 1.0
    put_rows(out, JACOBIAN + 21, rows, 6)
    # coordinate rates: velocity and half the quaternion product q (0, omega)
    write_vector(out, _RATES, vector_at(u, 0))
    out[_RATES + 3] = 0.5 * (-b * ox - c * oy - d * oz)
    out[_RATES + 4] = 0.5 * (a * ox + c * oz - d * oy)
    out[_RATES + 5] = 0.5 * (a * oy + d * ox - b * oz)
    out[_RATES + 6] = 0.5 * (a * oz + b * oy - c * ox)
    # force and gyroscopic moment
    gravity = gravity_x, gravity_y, gravity_z
    write_vector(out, _FORCE, scaled(mass, gravity))
    (jx, jy, jz), (jyz, jxz, jxy) = vector_at(inertia, 0), vector_at(inertia, 3)
    # -omega x (J omega), grouped so that in principal axes nothing but the differences of the moments is left
    out[_FORCE + 3] = (jy - jz) * oy * oz + (jyz * (oz * oz - oy * oy) + ox * (jxy * oz - jxz * oy))
    out[_FORCE + 4] = (jz - jx) * oz * ox + (jxz * (ox * ox - oz * oz) + oy * (jyz * ox - jxy * oz))
    out[_FORCE + 5] = (jx - jy) * ox * oy + (jxy * (oy * oy - ox * ox) + oz * (jxz * oy - jyz * ox))
    out[_INVERSE] = out[_INVERSE + 7] = out[_INVERSE + 14] = 1.0 / mass
    for i in range(3):
        write_vector(out, _INVERSE + 21 + 6 * i, vector_at(inverse_inertia, 3 * i))
    velocity = vector_at(u, 0)
    in_axes = mass * dot(velocity, velocity) + jx * ox * ox + jy * oy * oy + jz * oz * oz
    out[_ENERGY] = 0.5 * in_axes + (jyz * oy * oz + jxz * ox * oz + jxy * ox * oy)
    out[_ENERGY + 1] = -mass * dot(gravity, vector_at(q, 0))


@compiled
def _turn(out: Floats, a: float, b: float, c: float, d: float, k: float, x: float, y: float, z: float) -> None:
    """Write the product of the quaternions (a, b, c, d) and (k, x, y, z)."""
    out[3] = a * k - b * x - c * y - d * z
    out[4] = b * k + a * x + c * z - d * y
    out[5] = c * k + a * y + d * x - b * z
    out[6] = d * k + a * z + b * y - c * x


def _fly(
    t: float, q: Floats, u: Floats, out: Floats, inertia: Floats, gravity_x: float, gravity_y: float, gravity_z: float
) -> None:
    half, (jx, jy, jz) = 0.5 * t, vector_at(inertia, 0)
    velocity, gravity = vector_at(u, 0), (gravity_x, gravity_y, gravity_z)
    write_vector(out, 0, plus_scaled(vector_at(q, 0), t, plus_scaled(velocity, half, gravity)))
    write_vector(out, 7, plus_scaled(velocity, t, gravity))
    ox, oy, oz = vector_at(u, 3)
    # the angular momentum over the moment of inertia across the axis of symmetry stays in space; what the spin about
    # that axis has more turns with the body
    ex = ey = ez = 0.0
    if jy == jz:
        ex = (1.0 - jx / jy) * ox
    elif jx == jz:
        ey = (1.0 - jy / jx) * oy
    else:
        ez = (1.0 - jz / jx) * oz
    x, y, z = ox - ex, oy - ey, oz - ez
    rate = math.sqrt(x * x + y * y + z * z)
    c, s = math.cos(half * rate), math.sin(half * rate)
    s = s / rate if rate > 0.0 else half
    _turn(out, q[3], q[4], q[5], q[6], c, s * x, s * y, s * z)
    if ex + ey + ez != 0.0:
        c, s = math.cos(half * (ex + ey + ez)), math.sin(half * (ex + ey + ez))
        x, y, z = s if ex != 0.0 else 0.0, s if ey != 0.0 else 0.0, s if ez != 0.0 else 0.0
        _turn(out, out[3], out[4], out[5], out[6], c, x, y, z)
        # twice that angle
        c, s = c * c - s * s, 2.0 * c * s
        if ex != 0.0:
            oy, oz = c * oy + s * oz, c * oz - s * oy
        elif ey != 0.0:
            oz, ox = c * oz + s * ox, c * ox - s * oz
        else:
            ox, oy = c * ox + s * oy, c * oy - s * ox
    write_vector(out, 10, (ox, oy, oz))


@functools.lru_cache(maxsize=256)
def _inverse_inertia(name: str, mass: float, moments: Triple, products: Triple) -> tuple[float, ...]:
    """Inverse of an inertia tensor, row by row [1/(kg m^2)]; raises an error if no body has this mass and inertia.

    Equal bodies share the result.
    """
    tensor = tensor_of(moments, products)
    check_inertia(name, mass, tensor)
    upper = np.triu(np.linalg.inv(tensor)) if any(products) else np.diag([1.0 / j for j in moments])
    return tuple((upper + np.triu(upper, 1).T).ravel().tolist())


class FreeBody(Body):
    """A rigid body that moves freely; its frame has its origin at the mass centre.

    Subclasses are final and give ``total_mass`` [kg], ``inertia`` [kg m^2] (moments about the axes of the frame),
    shapes and, if its axes are not principal axes, ``products`` [kg m^2].  They are checked when the body is made.
    Coordinates: position of the mass centre [m], unit quaternion (scalar first) from body to world.
    Velocities: of the mass centre in world axes [m/s], angular velocity in body axes [rad/s].
    """

    q_labels, u_labels, quaternion = POSE_LABELS, TWIST_LABELS, 3
    evaluator: ClassVar[Callable[..., None]] = staticmethod(_evaluate)

    def __post_init__(self) -> None:
        super().__post_init__()
        try:
            self.parameters()
        except OverflowError as error:
            remedy = "Take smaller lengths and densities."
            raise InvalidInput(
                f"{type(self).__name__}: mass and inertia", "must be finite", str(error), remedy
            ) from error

    @property
    @abstractmethod
    def total_mass(self) -> float:
        """Mass [kg]."""

    @property
    @abstractmethod
    def inertia(self) -> tuple[float, float, float]:
        """Moments of inertia J_xx, J_yy, J_zz about the mass centre in the axes of the frame [kg m^2]."""

    @property
    def products(self) -> tuple[float, float, float]:
        """Elements J_yz, J_xz, J_xy of the inertia tensor [kg m^2], J_xy = -integral of x y dm; zero by default."""
        return 0.0, 0.0, 0.0

    def parameters(self) -> Mapping[str, Value]:
        """Return mass, inertia (moments, then products) and the inverse of the tensor, row by row, all checked."""
        name = type(self).__name__
        mass, moments, products = self.total_mass, tuple(self.inertia), tuple(self.products)
        for part, values in (("inertia", moments), ("products", products)):
            if len(values) != 3:
                raise InvalidInput(f"{name}.{part}", "must be three numbers", values, "Give them in [kg m^2].")
        inverse = _inverse_inertia(name, mass, moments, products)
        return {"mass": mass, "inertia": (*moments, *products), "inverse_inertia": inverse}

    @property
    @abstractmethod
    def shapes(self) -> tuple[Shape, ...]:
        """The shapes that the body carries."""

    @functools.cached_property
    def frames(self) -> tuple[tuple[Shape, ...], ...]:
        """The body's single frame, with all its shapes."""
        return (check_carried(f"{type(self).__name__}.shapes", self.shapes),)

    @property
    def spin(self) -> int:
        """Offset of the angular velocity in u, 3, for a symmetric top; else -1.

        The offset makes the engine integrate the angular velocity in space axes.  In these axes the angular velocity of
        a symmetric top changes slowly, the angular velocity of any other body as fast as the body turns.  Space axes
        cost accuracy: between steps, the components along body axes are computed from the attitude and contain the
        error of the attitude.  A ball gains nothing from space axes, because its free angular velocity is constant in
        both kinds of axes: for a ball the result is -1.
        """
        return 3 if self._is_symmetric and len(set(self.inertia)) == 2 else -1

    @property
    def flight(self) -> Callable[..., None] | None:
        """Closed-form motion of a ball or a symmetric top about an axis of the frame; None for another body."""
        return _fly if self._is_symmetric else None

    @property
    def _is_symmetric(self) -> bool:
        x, y, z = self.inertia
        return not any(self.products) and (x == y or y == z or x == z)

    @property
    def length_scale(self) -> float:
        """Largest length of its shapes, at least its largest radius of gyration [m]."""
        gyration = math.sqrt(max(self.inertia) / self.total_mass)
        return max([gyration, *(shape.length for shape in self.frames[0])])

    def state(self, **start: Any) -> tuple[Vector, Vector]:
        """Return coordinates q and velocities u of the body.

        Parameters
        ----------
        **start
            Keywords of the start, each by default zero or the unit rotation: ``position`` of the mass centre in world
            axes [m], shape [3]; ``orientation``, the unit quaternion (w, x, y, z) from body axes to world axes;
            ``velocity`` of the mass centre in world axes [m/s], shape [3]; ``angular_velocity`` in body axes [rad/s],
            shape [3].
        """
        values = read_start(type(self).__name__, _WORDS, start)
        q = np.concatenate([values["position"], values["orientation"]])
        return q, np.concatenate([values["velocity"], values["angular_velocity"]])


class TensorBody(FreeBody):
    """A free body whose axes need not be principal axes; subclasses are final and give ``_tensor``, computed once."""

    @property
    @abstractmethod
    def _tensor(self) -> Vector:
        """Inertia tensor about the mass centre in the axes of the frame [kg m^2], shape [3, 3]."""

    @property
    @final
    def inertia(self) -> tuple[float, float, float]:
        """Diagonal of the inertia tensor [kg m^2]."""
        x, y, z = self._tensor.diagonal().tolist()
        return x, y, z

    @property
    @final
    def products(self) -> tuple[float, float, float]:
        """Elements J_yz, J_xz, J_xy of the inertia tensor [kg m^2]."""
        tensor = self._tensor
        return float(tensor[1, 2]), float(tensor[0, 2]), float(tensor[0, 1])
