"""Table: positions at given times, joined by a spline."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, final

import numpy as np

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import ACCELERATION, VELOCITY
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Motion
from nonsmooth.interfaces.body import Vector
from nonsmooth.parameters import Value
from nonsmooth.types import Floats

from ..blocks import pose_of, write_pose
from ..values import check_fields

_SAME_TIME = 1e-6
_SAME_PLACE = 1e-3


@compiled
def _write(out: Floats, times: Floats, coefficients: Floats, count: float, t: float) -> None:
    """Write position, velocity and acceleration at ``t``; outside of the table the velocity stays."""
    low, high = 0, int(count) - 1
    last = times[high]
    while high - low > 1:
        middle = (low + high) // 2
        if t >= times[middle]:
            low = middle
        else:
            high = middle
    inside = min(max(t, times[0]), last)
    d, rest = inside - times[low], t - inside
    for i in range(3):
        c = 12 * low + 4 * i
        velocity = (3.0 * coefficients[c] * d + 2.0 * coefficients[c + 1]) * d + coefficients[c + 2]
        position = ((coefficients[c] * d + coefficients[c + 1]) * d + coefficients[c + 2]) * d + coefficients[c + 3]
        out[i] = position + velocity * rest
        out[VELOCITY + i] = velocity
        # a natural spline has none at its ends
        out[ACCELERATION + i] = 6.0 * coefficients[c] * d + 2.0 * coefficients[c + 1] if rest == 0.0 else 0.0


def _evaluate(
    t: float, q: Floats, u: Floats, out: Floats, count: float, times: Floats, coefficients: Floats, pose: Floats
) -> None:
    write_pose(out, pose)
    _write(out, times, coefficients, count, t)


def _evaluate_periodic(
    t: float, q: Floats, u: Floats, out: Floats, count: float, times: Floats, coefficients: Floats, pose: Floats
) -> None:
    first = times[0]
    period = times[int(count) - 1] - first
    write_pose(out, pose)
    _write(out, times, coefficients, count, t - period * math.floor((t - first) / period))


@final
@dataclass(frozen=True)
class Table(Motion):
    """Positions at given times, joined by a cubic spline whose acceleration is continuous.

    A periodic table repeats for ever.  Any other has no acceleration at its ends (a natural spline), and goes on with
    the velocity that it has there.

    Attributes
    ----------
    times : sequence of float
        Increasing times [s, shape (n)], n at least 2, periodic at least 3.
    positions : sequence of sequence of float
        Positions of the origin of the frame [m, shape (n, 3)]; the last of a periodic table is the first again.
    periodic : bool
        Whether it repeats.
    orientation : tuple of float
        Unit quaternion (scalar first) of the frame, at all times.

    Raises
    ------
    InvalidInput
        If a shape is wrong, a number not finite, times do not increase, or the position jumps.
    """

    times: Sequence[float]
    positions: Sequence[Sequence[float]]
    periodic: bool = False
    orientation: tuple[float, float, float, float] = (1.0, 0.0, 0.0, 0.0)
    _coefficients: tuple[float, ...] = field(init=False, repr=False, compare=False)
    _time_scale: float = field(init=False, repr=False, compare=False)

    @classmethod
    def example(cls) -> Mapping[str, Any]:
        """Return a loop around three corners."""
        return {
            "times": (0.0, 0.1, 0.3, 0.5),
            "positions": ((0.0, 0.0, 0.0), (0.1, 0.0, 0.0), (0.0, 0.0, 0.1), (0.0, 0.0, 0.0)),
            "periodic": True,
        }

    def _check(self) -> None:
        from scipy.interpolate import CubicSpline

        times = _numbers("Table.times", self.times, 1, "s")
        positions = _numbers("Table.positions", self.positions, 2, "m")
        _check_rows(times, positions, self.periodic)
        spline = CubicSpline(times, positions, bc_type="periodic" if self.periodic else "natural")
        object.__setattr__(self, "times", tuple(times.tolist()))
        object.__setattr__(self, "positions", tuple(map(tuple, positions.tolist())))
        check_fields(self, "orientation")
        # per interval, per coordinate, from the cube down
        object.__setattr__(self, "_coefficients", tuple(np.transpose(spline.c, (1, 2, 0)).ravel().tolist()))
        object.__setattr__(self, "_time_scale", _time_scale(times, positions, spline.c))

    def parameters(self) -> Mapping[str, Value]:
        """Return times [s], coefficients of the spline, and the constant orientation as a pose at the origin."""
        return {
            "count": float(len(self.times)),
            "times": tuple(self.times),
            "coefficients": self._coefficients,
            "pose": pose_of((0.0, 0.0, 0.0), self.orientation),
        }

    @property
    def evaluator(self) -> Callable[..., None]:
        """The spline."""
        return _evaluate_periodic if self.periodic else _evaluate

    @property
    def period(self) -> float | None:
        """The time from the first row to the last [s]; None if the table is not periodic."""
        return self.times[-1] - self.times[0] if self.periodic else None

    @property
    def time_scale(self) -> float:
        """2 pi times the smallest ratio of the largest velocity to acceleration, acceleration to jerk [s]."""
        return self._time_scale


def _numbers(thing: str, value: Any, dimensions: int, unit: str) -> Vector:
    try:
        array = np.array(value, dtype=float)
    except (TypeError, ValueError):
        array = np.zeros(())
    if array.ndim != dimensions or (dimensions == 2 and array.shape[1] != 3):
        shape = "(n)" if dimensions == 1 else "(n, 3)"
        raise InvalidInput(
            thing, f"must be an array of numbers of shape {shape}", np.shape(array), f"Give one row a time in [{unit}]."
        )
    if not np.all(np.isfinite(array)):
        row = int(np.argmax(~np.isfinite(array).reshape(len(array), -1).all(axis=1)))
        raise InvalidInput(f"{thing}[{row}]", "must be finite", array[row].tolist(), "Take the row out or correct it.")
    return array


def _check_rows(times: Vector, positions: Vector, periodic: bool) -> None:
    if len(times) != len(positions) or len(times) < 2 + periodic:
        raise InvalidInput(
            "Table",
            f"must have as many times as positions, at least {2 + periodic}",
            (len(times), len(positions)),
            "Give one position a time.",
        )
    steps = np.diff(times)
    if np.any(steps <= 0.0):
        row = int(np.argmax(steps <= 0.0)) + 1
        raise InvalidInput(
            f"Table.times[{row}]", f"must be above {times[row - 1]:g} [s]", float(times[row]), "Sort the rows by time."
        )
    size = float(np.max(np.ptp(positions, axis=0)))
    moves = np.linalg.norm(np.diff(positions, axis=0), axis=1)
    jumps = (steps < _SAME_TIME * np.median(steps)) & (moves > _SAME_PLACE * size)
    if np.any(jumps):
        row = int(np.argmax(jumps)) + 1
        raise InvalidInput(
            f"Table.positions[{row}]",
            f"must not jump away from the row {steps[row - 1]:.3g} s before",
            positions[row].tolist(),
            "A motion is smooth; spread the change over several rows, or take one of the two out.",
        )
    if periodic and np.linalg.norm(positions[-1] - positions[0]) > 0.0:
        raise InvalidInput(
            "Table.positions[-1]",
            f"must be the first, {positions[0].tolist()}, again in a periodic table",
            positions[-1].tolist(),
            "Append the first row at the time when the table repeats.",
        )


def _time_scale(times: Vector, positions: Vector, c: Vector) -> float:
    """Return the shortest time [s] over which the spline of coefficients ``c`` [4, n - 1, 3] changes."""
    # velocity, acceleration and jerk at the knots; neither of the table's resolution nor of its length
    largest = [float(np.max(np.linalg.norm(f * c[i], axis=-1))) for i, f in ((2, 1.0), (1, 2.0), (0, 6.0))]
    shortest = math.inf
    for slow, fast in itertools.pairwise(largest):
        if fast <= 1e-9 * slow / float(times[-1] - times[0]):
            break
        shortest = min(shortest, 2.0 * math.pi * slow / fast)
    return max(shortest, 2.0 * float(np.min(np.diff(times))))
