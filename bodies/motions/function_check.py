"""Whether functions of time are a motion: finite, of the right shape, derivatives of one another, without jumps."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.body import Vector

Function: TypeAlias = Callable[[float], Any]
_Rule: TypeAlias = Callable[[Vector, Vector, float], Vector]

_PER_SCALE = 64
_FEWEST, _MOST = 256, 20000
_STEP = 1e-4
_DERIVATIVE = 1e-5
_JUMP = 1e-4
_NOISE = 1e-13
_SUSPECTS = 8
_HALVINGS = 30


def check_linear(functions: Sequence[Function], duration: float, scale: float) -> None:
    """Check position, velocity and acceleration over [0, duration], in steps of a fraction of ``scale`` [s].

    Raises
    ------
    InvalidInput
        If one raises, returns no tuple of three finite numbers, jumps, or is not the derivative of the one before.
    """
    labels = [_label(name, f) for name, f in zip(("position", "velocity", "acceleration"), functions, strict=True)]
    readers = [_reader(label, f, 3) for label, f in zip(labels, functions, strict=True)]
    for read in readers:
        read(0.0)
    _check_chain(labels, readers, (_difference, _difference), duration, scale)


def check_turn(functions: Sequence[Any], duration: float, scale: float) -> None:
    """Check unit quaternion, angular velocity and angular acceleration; see :func:`check_linear`."""
    names = ("orientation", "angular_velocity", "angular_acceleration")
    labels = [_label(name, f) for name, f in zip(names, functions, strict=True)]
    readers = [_reader(label, f, size) for label, f, size in zip(labels, functions, (4, 3, 3), strict=True)]
    for read in readers:
        read(0.0)
    for t in _times(duration, scale):
        norm = float(np.linalg.norm(readers[0](float(t))))
        if abs(norm - 1.0) > 1e-9:
            raise InvalidInput(
                labels[0], f"must return a unit quaternion (at t = {t:.6g} s)", norm, "Divide it by its length."
            )
    _check_chain(labels, readers, (_turn, _difference), duration, scale)


def _label(name: str, function: Any) -> str:
    if not inspect.isfunction(function):
        raise InvalidInput(
            f"FunctionMotion.{name}", "must be a plain function of time", function, "Give a def or a lambda."
        )
    return f"FunctionMotion.{name} ({function.__qualname__})"


def _reader(label: str, function: Function, size: int) -> Callable[[float], Vector]:
    def read(t: float) -> Vector:
        try:
            value = function(t)
        except Exception as error:
            raise InvalidInput(label, f"must return at t = {t:.6g} s", error, "Look at the function.") from error
        if not isinstance(value, tuple) or len(value) != size or not all(_is_number(x) for x in value):
            remedy = f"Write `return {', '.join('xyzw'[:size])}` with {size} floats."
            raise InvalidInput(label, f"must return a tuple of {size} numbers (at t = {t:.6g} s)", value, remedy)
        if not all(math.isfinite(x) for x in value):
            raise InvalidInput(label, f"must be finite (at t = {t:.6g} s)", value, "Look for a division by zero.")
        return np.array(value, dtype=float)

    return read


def _is_number(x: Any) -> bool:
    return isinstance(x, (int, float, np.integer, np.floating)) and not isinstance(x, bool)


def _times(duration: float, scale: float) -> Vector:
    n = int(min(max(_PER_SCALE * duration / scale, _FEWEST), _MOST))
    return np.linspace(0.0, duration, n + 1)


def _difference(one: Vector, other: Vector, dt: float) -> Vector:
    return np.asarray((other - one) / dt)


def _turn(one: Vector, other: Vector, dt: float) -> Vector:
    """Return the mean angular velocity in world axes between two unit quaternions of nearly the same turn."""
    a, e = one[0], other[0]
    sign = 1.0 if one @ other >= 0.0 else -1.0
    part = a * other[1:] - e * one[1:] - np.cross(other[1:], one[1:])
    return np.asarray(2.0 * sign * part / dt)


def _check_chain(
    labels: Sequence[str],
    readers: Sequence[Callable[[float], Vector]],
    rules: Sequence[_Rule],
    duration: float,
    scale: float,
) -> None:
    times = _times(duration, scale)
    values = [np.array([read(float(t)) for t in times]) for read in readers]
    for label, read, value in zip(labels, readers, values, strict=True):
        _check_jumps(label, read, times, value)
    # central differences, so inside of the ends; smaller than the distance of the samples
    h, inside = _STEP * min(scale, duration), times[1:-1].tolist()
    for i, rule in enumerate(rules):
        given = values[i + 1][1:-1]
        slopes = np.array([rule(readers[i](t - h), readers[i](t + h), 2.0 * h) for t in inside])
        size = max(float(np.max(np.linalg.norm(x, axis=1))) for x in (given, slopes))
        noise = _NOISE * float(np.max(np.abs(values[i]))) / h
        errors = np.linalg.norm(slopes - given, axis=1)
        worst = int(np.argmax(errors))
        if errors[worst] > _DERIVATIVE * size + noise:
            raise InvalidInput(
                labels[i + 1],
                f"must be the derivative of {labels[i]}, {slopes[worst].tolist()} at t = {inside[worst]:.6g} s",
                given[worst].tolist(),
                "Differentiate again; if it is right, the shortest time of change is shorter than given.",
            )


def _check_jumps(label: str, read: Callable[[float], Vector], times: Vector, values: Vector) -> None:
    """Halve the steps with the largest second differences: a jump stays as it is, everything else shrinks."""
    size = float(np.max(np.ptp(values, axis=0)))
    if size == 0.0:
        return
    bends = np.zeros(len(times) - 1)
    second = np.linalg.norm(values[2:] - 2.0 * values[1:-1] + values[:-2], axis=1)
    bends[1:], bends[:-1] = second, np.maximum(bends[:-1], second)
    for start in np.argsort(bends)[::-1][:_SUSPECTS]:
        low, high = float(times[start]), float(times[start + 1])
        first, last = values[start], values[start + 1]
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            between = read(middle)
            if np.linalg.norm(between - first) > np.linalg.norm(last - between):
                high, last = middle, between
            else:
                low, first = middle, between
        if np.linalg.norm(last - first) > _JUMP * size:
            raise InvalidInput(
                label,
                f"must not jump at t = {low:.9g} s",
                (first.tolist(), last.tolist()),
                "A motion is smooth, acceleration included; round the corner off.",
            )
