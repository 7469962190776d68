"""Makes two compiled functions of a body from the user's functions of mass, force, potential and so on.

The evaluator writes the body's output block for the engine.  The probe writes the output of each user function
separately, so that checks can examine it.
"""

from __future__ import annotations

import functools
import inspect
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

from nonsmooth.compiled import compiled
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.engine.native.kernel import at
from nonsmooth.types import Floats

from .frames import Function, MovingFrame

LEADING = {
    "mass": ("q", "out"),
    "force": ("t", "q", "u", "out"),
    "potential": ("q",),
    "power": ("t", "q", "u"),
    "drawn": ("q",),
    "pose": ("q", "out"),
    "jacobian": ("q", "out"),
    "bias": ("q", "u", "out"),
}
"""Leading arguments of a body's functions, by role, that is by what the function computes; constants follow."""


class UserFunction(NamedTuple):
    """A user's function of a body.

    Attributes
    ----------
    variable : str
        Name for the function in the generated source text, such as "pose_0".
    name : str
        Name in messages, such as "moving_frames[0].pose".
    role : str
        Key of its leading arguments in ``LEADING``, such as "pose".
    function : callable
        The function.
    size : int
        Number of values that it returns or writes.
    """

    variable: str
    name: str
    role: str
    function: Callable[..., Any]
    size: int


@dataclass(frozen=True)
class Equations:
    """The user's functions that define a body.

    The frames in ``frames`` have no shapes, so that bodies with equal functions but different shapes share compiled
    code.
    """

    n: int
    mass: Function
    force: Function
    potential: Callable[..., float]
    power: Callable[..., float] | None
    frames: tuple[MovingFrame, ...]

    def parts(self) -> tuple[UserFunction, ...]:
        """Return all functions that the user has given."""
        n = self.n
        found = [
            UserFunction("mass", "mass", "mass", self.mass, n * n),
            UserFunction("force", "force", "force", self.force, n),
            UserFunction("potential", "potential", "potential", self.potential, 1),
        ]
        if self.power is not None:
            found.append(UserFunction("power", "power", "power", self.power, 1))
        for i, frame in enumerate(self.frames):
            name = f"moving_frames[{i}]"
            found += [
                UserFunction(f"pose_{i}", f"{name}.pose", "pose", frame.pose, frame.n_pose),
                UserFunction(f"jacobian_{i}", f"{name}.jacobian", "jacobian", frame.jacobian, frame.n_rows * n),
                UserFunction(f"bias_{i}", f"{name}.bias", "bias", frame.bias, frame.n_rows),
            ]
        return tuple(found)


GUARD = 16
"""Number of floats before and after the output of each user function in the array of :func:`probe`.

If a function changes one of these floats, it has used a wrong index.
"""


def places(equations: Equations) -> tuple[tuple[UserFunction, int], ...]:
    """Return every user function with the index at which its output begins in the array of :func:`probe`."""
    found, start = [], GUARD
    for part in equations.parts():
        found.append((part, start))
        start += part.size + GUARD
    return tuple(found)


def own_names(function: Callable[..., Any], role: str) -> tuple[str, ...]:
    """Return the names of the constants among a function's arguments."""
    return tuple(inspect.signature(function).parameters)[len(LEADING[role]) :]


@functools.cache
def evaluator(equations: Equations) -> Callable[..., None]:
    """Return ``evaluate(t, q, u, out, ...)``, which writes the output block of the body."""
    n, frame_size = equations.n, FRAME + 6 * equations.n
    tail = frame_size * len(equations.frames)
    n_q = n + (equations.power is not None)
    force, inverse = tail + n_q, tail + n_q + n
    energy = inverse + n * n
    lines = []
    for i, frame in enumerate(equations.frames):
        start = i * frame_size
        lines += [
            f"head_{i}(at(out, {start}))",
            _call(equations, f"pose_{i}", start),
            _call(equations, f"jacobian_{i}", start + FRAME),
            f"multiply({frame.n_rows}, {n}, at(out, {start + FRAME}), u, at(out, {start + 12}))",
            _call(equations, f"bias_{i}", start + 18),
        ]
    lines += [
        *(f"out[{tail + i}] = u[{i}]" for i in range(n)),
        f"clear({n + n * n}, at(out, {force}))",
        _call(equations, "force", force),
        _call(equations, "mass", inverse),
        f"out[{energy}] = quadratic({n}, at(out, {inverse}), u)",
        f"invert({n}, at(out, {inverse}))",
        f"out[{energy + 1}] = {_call(equations, 'potential', 0)}",
    ]
    if equations.power is not None:
        lines += [f"out[{tail + n}] = {_call(equations, 'power', 0)}", f"out[{energy + 1}] -= q[{n}]"]
    return _function(equations, "evaluate", lines)


@functools.cache
def probe(equations: Equations) -> Callable[..., None]:
    """Return ``probe(t, q, u, out, ...)``, which writes the output of each user function separately, for checks.

    The output of a function begins in ``out`` at the index that :func:`places` returns for this function.
    """
    lines = []
    for part, start in places(equations):
        call = _call(equations, part.variable, start)
        lines.append(call if "out" in LEADING[part.role] else f"out[{start}] = {call}")
    return _function(equations, "probe", lines)


def _call(equations: Equations, variable: str, start: int) -> str:
    """Return the source text of a call of a function that writes to ``out`` from the offset ``start`` on."""
    part = next(part for part in equations.parts() if part.variable == variable)
    leading = [f"at(out, {start})" if name == "out" else name for name in LEADING[part.role]]
    constants = [f"c_{name}" for name in own_names(part.function, part.role)]
    return f"f_{variable}({', '.join([*leading, *constants])})"


def _function(equations: Equations, name: str, lines: list[str]) -> Callable[..., None]:
    """Return the Python function ``name`` whose body consists of the source ``lines``.

    Its arguments are t, q, u, out and the body's constants.  The lines call the user's functions, which are compiled.
    """
    parts = equations.parts()
    names = sorted({own for part in parts for own in own_names(part.function, part.role)})
    scope: dict[str, Any] = {
        "__name__": __name__,
        "at": at,
        "clear": clear,
        "multiply": multiply,
        "quadratic": quadratic,
        "invert": invert,
        **{f"f_{part.variable}": _compiled(part.function) for part in parts},
        **{f"head_{i}": _compiled(frame.head) for i, frame in enumerate(equations.frames)},
    }
    # constants get a prefix, so that none of them can hide a name that the lines use
    lines = [*(f"c_{own} = {own}" for own in names), *lines]
    exec(f"def {name}({', '.join(['t', 'q', 'u', 'out', *names])}):\n " + "\n ".join(lines), scope)
    made: Callable[..., None] = scope[name]
    made.__qualname__ = f"{name} of {equations.mass.__qualname__}"
    return made


@functools.cache
def _compiled(function: Callable[..., Any]) -> Any:
    return compiled(function)


@compiled
def clear(n: int, out: Floats) -> None:
    """Write n zeros."""
    for i in range(n):
        out[i] = 0.0


@compiled
def multiply(rows: int, n: int, matrix: Floats, vector: Floats, out: Floats) -> None:
    """Write matrix times vector; the matrix has ``rows`` rows of n."""
    for i in range(rows):
        total = 0.0
        for j in range(n):
            total += matrix[i * n + j] * vector[j]
        out[i] = total


@compiled
def quadratic(n: int, matrix: Floats, vector: Floats) -> float:
    """Return vector . matrix vector / 2."""
    total = 0.0
    for i in range(n):
        for j in range(n):
            total += matrix[i * n + j] * vector[i] * vector[j]
    return 0.5 * total


@compiled
def invert(n: int, matrix: Floats) -> None:
    """Replace a symmetric positive definite matrix by its inverse, by Cholesky factorisation.

    Only the lower triangle is read.  If the matrix is not positive definite, the result is not finite.
    """
    for j in range(n):
        pivot = matrix[j * n + j]
        for m in range(j):
            pivot -= matrix[j * n + m] * matrix[j * n + m]
        matrix[j * n + j] = math.sqrt(pivot) if pivot > 0.0 else math.nan
        for i in range(j + 1, n):
            total = matrix[i * n + j]
            for m in range(j):
                total -= matrix[i * n + m] * matrix[j * n + m]
            matrix[i * n + j] = total / matrix[j * n + j]
    # replace the factor L by its inverse, column by column
    for j in range(n):
        matrix[j * n + j] = 1.0 / matrix[j * n + j]
        for i in range(j + 1, n):
            total = 0.0
            for m in range(j, i):
                total -= matrix[i * n + m] * matrix[m * n + j]
            matrix[i * n + j] = total / matrix[i * n + i]
    # replace L^-1 by L^-T L^-1, whose row i needs no row above
    for i in range(n):
        for j in range(i + 1):
            total = 0.0
            for m in range(i, n):
                total += matrix[m * n + i] * matrix[m * n + j]
            matrix[i * n + j] = total
            matrix[j * n + i] = total
