"""FunctionMotion: a motion written as Python functions of time."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeAlias, final

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import ACCELERATION, POSITION, ROTATION, SPIN, SPIN_ACCELERATION, VELOCITY
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Motion
from nonsmooth.parameters import parameter
from nonsmooth.types import Floats

from ..blocks import put_rows, rotation_of
from .function_check import Function, check_linear, check_turn

Evaluator: TypeAlias = Callable[..., None]


def _translation(position: Function, velocity: Function, acceleration: Function) -> Evaluator:
    p, v, a = compiled(position), compiled(velocity), compiled(acceleration)

    def evaluate(t: float, q: Floats, u: Floats, out: Floats) -> None:
        out[POSITION], out[POSITION + 1], out[POSITION + 2] = p(t)
        out[ROTATION] = out[ROTATION + 4] = out[ROTATION + 8] = 1.0
        out[VELOCITY], out[VELOCITY + 1], out[VELOCITY + 2] = v(t)
        out[ACCELERATION], out[ACCELERATION + 1], out[ACCELERATION + 2] = a(t)

    return evaluate


def _turning(translation: Evaluator, orientation: Function, velocity: Function, acceleration: Function) -> Evaluator:
    move, r, v, a = compiled(translation), compiled(orientation), compiled(velocity), compiled(acceleration)

    def evaluate(t: float, q: Floats, u: Floats, out: Floats) -> None:
        move(t, q, u, out)
        w, x, y, z = r(t)
        put_rows(out, ROTATION, rotation_of(w, x, y, z))
        out[SPIN], out[SPIN + 1], out[SPIN + 2] = v(t)
        out[SPIN_ACCELERATION], out[SPIN_ACCELERATION + 1], out[SPIN_ACCELERATION + 2] = a(t)

    return evaluate


def _swing(t: float) -> tuple[float, float, float]:
    return 0.1 * math.sin(t), 0.0, 0.02 * math.cos(t)


def _swing_rate(t: float) -> tuple[float, float, float]:
    return 0.1 * math.cos(t), 0.0, -0.02 * math.sin(t)


def _swing_bias(t: float) -> tuple[float, float, float]:
    return -0.1 * math.sin(t), 0.0, -0.02 * math.cos(t)


def _rock(t: float) -> tuple[float, float, float, float]:
    half = 0.1 * math.sin(t)
    return math.cos(half), 0.0, math.sin(half), 0.0


def _rock_rate(t: float) -> tuple[float, float, float]:
    return 0.0, 0.2 * math.cos(t), 0.0


def _rock_bias(t: float) -> tuple[float, float, float]:
    return 0.0, -0.2 * math.sin(t), 0.0


@final
@dataclass(frozen=True)
class FunctionMotion(Motion):
    """A motion given by plain Python functions of time [s], each returning a tuple of floats; numba compiles them.

    The functions are sampled over ``duration`` when the motion is made: values must be finite, and velocities and
    accelerations the derivatives, without jumps.  Later values are not checked.

    Attributes
    ----------
    position, velocity, acceleration : callable
        Of the origin of the frame: (x, y, z) [m], [m/s], [m/s^2].
    duration : float
        Time over which the functions are checked [s]; give the end of the run, or a period.
    shortest_change : float
        Shortest time in which the motion changes appreciably [s], such as the period of its fastest vibration.  It
        limits the steps of the engine.
    orientation, angular_velocity, angular_acceleration : callable, optional
        Of the frame: unit quaternion (scalar first), (x, y, z) in world axes [rad/s], [rad/s^2]; all three or none.

    Raises
    ------
    InvalidInput
        A function raised an exception or did not return a tuple of the right number of finite floats; a velocity or
        acceleration is not the derivative of the function before it; or the functions of the rotation are incomplete.
    """

    position: Function
    velocity: Function
    acceleration: Function
    duration: float = parameter(doc="time over which the functions are checked", unit="s", above=0.0)
    shortest_change: float = parameter(doc="shortest time over which it changes", unit="s", above=0.0)
    orientation: Function | None = None
    angular_velocity: Function | None = None
    angular_acceleration: Function | None = None
    _evaluator: Evaluator = field(init=False, repr=False, compare=False)

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return a body that swings and rocks."""
        return {
            "position": _swing,
            "velocity": _swing_rate,
            "acceleration": _swing_bias,
            "orientation": _rock,
            "angular_velocity": _rock_rate,
            "angular_acceleration": _rock_bias,
            "duration": 2.0 * math.pi,
            "shortest_change": 2.0 * math.pi,
        }

    def _check(self) -> None:
        span = self.duration, self.shortest_change
        check_linear((self.position, self.velocity, self.acceleration), *span)
        evaluator = _translation(self.position, self.velocity, self.acceleration)
        turn: Any = self.orientation, self.angular_velocity, self.angular_acceleration
        if any(function is not None for function in turn):
            for name, function in zip(("orientation", "angular_velocity", "angular_acceleration"), turn, strict=True):
                if function is None:
                    raise InvalidInput(
                        f"FunctionMotion.{name}", "must be given with the other two", None, "A turn needs all three."
                    )
            check_turn(turn, *span)
            evaluator = _turning(evaluator, *turn)
        object.__setattr__(self, "_evaluator", evaluator)

    def parameters(self) -> dict[str, float]:
        """Return nothing: the functions know all."""
        return {}

    @property
    def evaluator(self) -> Evaluator:
        """The functions, put together."""
        return self._evaluator

    @property
    def time_scale(self) -> float:
        """As given [s]."""
        return self.shortest_change
