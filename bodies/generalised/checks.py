"""Checks of the user's functions of a body.

Outputs must have the right size and be finite.  Functions that are derivatives of others must agree with finite
differences of them.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.binding.call import body_caller
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.parameters import Value

from .equations import GUARD, LEADING, Equations, UserFunction, own_names, places, probe

Vector = NDArray[np.float64]

_STEP = 1e-3
"""Step of the finite differences, relative to the scales of q and u.

The differences are of fourth order: their relative error is of the order of step^4, 1e-12.
"""
_ALLOWED = 1e-6
_LOOK = "Look at the signs of the potential's derivatives and at the terms quadratic in u"
_ASIDE = 0.01
"""Shift from the start to the second configuration that is checked, relative to the scales of the coordinates.

A start is often symmetric, so that many terms vanish there and a mistake in them would not be found.
"""


def check_equations(sample: Sampler, q: Vector, u: Vector, q_scale: Vector, u_scale: Vector) -> None:
    """Check the functions at the start and at a shifted configuration, each with two sets of velocities.

    Raises
    ------
    InvalidInput
        The mass matrix is not symmetric and positive definite, a rotation matrix is not orthogonal, a Jacobian is not
        the derivative of its pose, a bias not the rate of its Jacobian times u, or forces and energies contradict each
        other.
    """
    # all numbers differ from 1 and from each other, so that a forgotten square or an exchanged index shows
    signs = (-1.0) ** np.arange(len(q)) * 1.37 / (1.0 + 0.7 * np.arange(len(q)))
    places, speeds = (q, q + _ASIDE * q_scale * signs[::-1]), (u, u + u_scale * signs)
    states = [(place, speed) for place in places for speed in speeds]
    frames = range(len(sample.equations.frames))
    # later checks use the functions of earlier ones, so that the message names the function with the mistake
    for place in places:
        _check_mass(sample, place, u)
    for place in places:
        for i in frames:
            _check_jacobian(sample, i, place, u, q_scale)
    for place, speed in states:
        for i in frames:
            _check_bias(sample, i, place, speed, q_scale)
    for place, speed in states:
        _check_force(sample, place, speed, q_scale)


def _check_mass(sample: Sampler, q: Vector, u: Vector) -> None:
    n = len(q)
    mass = sample(q, u)["mass"].reshape(n, n)
    thing, shown = sample.thing("mass"), mass.tolist()
    # entries may have different units: errors are relative to the diagonal entries
    size = np.sqrt(np.abs(np.diag(mass)))
    if not np.all(np.abs(mass - mass.T) <= 1e-12 * np.outer(size, size)):
        raise InvalidInput(thing, "must write a symmetric matrix", shown, "Write M[i n + j] and M[j n + i] alike.")
    if not (np.all(np.diag(mass) > 0.0) and np.min(np.linalg.eigvalsh(mass / np.outer(size, size))) > 1e-13):
        raise InvalidInput(
            thing,
            f"must write a positive definite matrix at q = {q.tolist()}",
            shown,
            "Every velocity needs inertia: the kinetic energy is u . M u / 2.",
        )


def _slope(function: Callable[[Vector], Vector], q: Vector, along: Vector) -> Vector:
    """Return the derivative of a function along a direction, of fourth order."""
    one, two = (function(q + s * along) - function(q - s * along) for s in (_STEP, 2.0 * _STEP))
    return (8.0 * one - two) / (12.0 * _STEP)


def _compare(
    sample: Sampler, part: str, words: tuple[str, str], given: Vector, found: Vector, weight: Vector, size: float
) -> None:
    """Hold what a function gives against what is found; ``size`` is that of the entries times their weight.

    ``words`` are the rule and the remedy.
    """
    error = np.abs(given - found) * weight
    if np.max(error, initial=0.0) > _ALLOWED * size:
        worst = np.unravel_index(int(np.argmax(error)), error.shape)
        index = ", ".join(str(int(i)) for i in worst)
        rule = f"{words[0]}: entry [{index}] should be {found[worst]:.9g}"
        raise InvalidInput(sample.thing(part), rule, float(given[worst]), words[1])


def _derivative_of(name: str) -> tuple[str, str]:
    return f"must be the derivative of {name}", f"Differentiate {name} once more, or correct that."


def _check_jacobian(sample: Sampler, i: int, q: Vector, u: Vector, q_scale: Vector) -> None:
    n, frame = len(q), sample.equations.frames[i]
    pose_name, jacobian_name = f"moving_frames[{i}].pose", f"moving_frames[{i}].jacobian"

    def pose(at: Vector) -> Vector:
        return np.asarray(sample(at, u)[pose_name])

    axes = pose(q)[3:].reshape(-1, 3)
    if len(axes) > 0 and not (np.allclose(axes.T @ axes, np.eye(3), atol=1e-9) and np.linalg.det(axes) > 0.0):
        raise InvalidInput(
            sample.thing(pose_name),
            "must write a rotation matrix behind the position",
            axes.tolist(),
            "Its columns are the axes of the part: unit vectors at right angles, right-handed.",
        )
    found = np.empty((frame.n_rows, n))
    for j in range(n):
        slope = _slope(pose, q, np.eye(n)[j] * q_scale[j]) / q_scale[j]
        found[:3, j] = slope[:3]
        if len(axes) > 0:
            spin = slope[3:].reshape(3, 3) @ axes.T
            twist = spin - spin.T
            found[3:, j] = 0.5 * twist[2, 1], 0.5 * twist[0, 2], 0.5 * twist[1, 0]
    given = sample(q, u)[jacobian_name].reshape(frame.n_rows, n)
    # what the differences lose to round-off goes with the pose itself
    lost = 1e-6 * float(np.max(np.abs(pose(q))))
    for rows, of in ((slice(0, 3), "the position"), (slice(3, 6), "the rotation")):
        size = float(np.max(np.abs(found[rows] * q_scale), initial=0.0)) + lost
        _compare(sample, jacobian_name, _derivative_of(of), given[rows], found[rows], q_scale, size)


def _check_bias(sample: Sampler, i: int, q: Vector, u: Vector, q_scale: Vector) -> None:
    n, frame = len(q), sample.equations.frames[i]
    jacobian_name, bias_name = f"moving_frames[{i}].jacobian", f"moving_frames[{i}].bias"

    def jacobian(at: Vector) -> Vector:
        return np.asarray(sample(at, u)[jacobian_name]).reshape(frame.n_rows, n)

    here = np.abs(jacobian(q) * q_scale)
    speed = float(np.max(np.abs(u) / q_scale)) or 1.0
    rates = _slope(lambda at: np.asarray(jacobian(at) @ u), q, u / speed) * speed
    bias = np.asarray(sample(q, u)[bias_name])
    words = _derivative_of("the Jacobian times u")
    for rows in (slice(0, 3), slice(3, 6)):
        size = float(np.max(here[rows], initial=0.0)) * speed**2
        _compare(sample, bias_name, words, bias[rows], rates[rows], np.ones(len(bias[rows])), size)


def _derivatives(sample: Sampler, q: Vector, u: Vector, q_scale: Vector) -> tuple[Vector, Vector]:
    """Return the derivatives of potential [n] and mass matrix [n, n, n] by each coordinate, the first index."""
    n = len(q)

    def both(at: Vector) -> Vector:
        found = sample(at, u)
        return np.concatenate([found["potential"], found["mass"]])

    slopes = np.array([_slope(both, q, np.eye(n)[j] * q_scale[j]) / q_scale[j] for j in range(n)])
    return slopes[:, 0], slopes[:, 1:].reshape(n, n, n)


def _check_force(sample: Sampler, q: Vector, u: Vector, q_scale: Vector) -> None:
    """Without a power, h is that of Lagrange's equations; with one, kinetic and potential energy change by it."""
    n, here = len(q), sample(q, u)
    potential, mass = _derivatives(sample, q, u, q_scale)
    terms = np.array([-potential, 0.5 * (mass @ u) @ u, -np.einsum("kij,k,j->i", mass, u, u)])
    # what the differences lose to round-off goes with the energies themselves
    lost = 1e-6 * (abs(float(here["potential"][0])) + 0.5 * float(u @ here["mass"].reshape(n, n) @ u))
    if "power" not in here:
        size = float(np.max(np.sum(np.abs(terms), axis=0) * q_scale)) + lost
        words = "must be that of Lagrange's equations", f"{_LOOK}; for forces without a potential, give their power."
        _compare(sample, "force", words, here["force"], terms.sum(axis=0), q_scale, size)
        return
    power, change = float(here["power"][0]), float(u @ (here["force"] - terms.sum(axis=0)))
    size = float(np.sum(np.abs(terms) * np.abs(u)) + np.sum(np.abs(here["force"] * u)))
    if not abs(change - power) <= _ALLOWED * (size + lost * float(np.max(np.abs(u) / q_scale))):
        raise InvalidInput(
            sample.thing("force"),
            f"must have the power {power:.9g} W beside that of the potential at q = {q.tolist()}, u = {u.tolist()}",
            change,
            f"{_LOOK}.",
        )


_SENTINEL = -7.0e250
GRAVITY = {"gravity_x": 1.1, "gravity_y": -2.3, "gravity_z": -9.7}
"""Gravity in the checks [m/s^2]: an oblique one, because the equations must hold with any gravity."""


def check_signatures(name: str, parts: Sequence[UserFunction], known: Mapping[str, Value]) -> None:
    """Check that all functions take the leading arguments of their role, then known constants only.

    Raises
    ------
    InvalidInput
        A part is not a plain function, or its first arguments are not those of its role.
    UnknownName
        A function takes a constant that was not given.
    """
    for _, part, role, function, _ in parts:
        expected = LEADING[role]
        if not inspect.isfunction(function):
            raise InvalidInput(f"{name}.{part}", "must be a plain function", function, f"Write {_form(role)}.")
        taken = tuple(inspect.signature(function).parameters)
        if taken[: len(expected)] != expected:
            raise InvalidInput(
                f"{name}.{part}: {function.__qualname__}", f"must begin with {expected}", taken, f"Write {_form(role)}."
            )
        for own in own_names(function, role):
            if own not in known:
                raise UnknownName(f"{name}.{part}: {function.__qualname__}: constant", own, known)


def _form(role: str) -> str:
    return f"def {role}({', '.join(LEADING[role])}, ...), then constants by name"


class Sampler:
    """Calls a body's functions, such as mass and force, as the engine does; detects writes outside of their outputs."""

    def __init__(self, name: str, equations: Equations, constants: Mapping[str, Value]) -> None:
        self.name = name
        self.equations = equations
        self.places = places(equations)
        self._functions = {part.name: part.function for part in equations.parts()}
        self._call = body_caller(probe(equations), {**constants, **GRAVITY}, name)
        last, start = self.places[-1]
        self._size = start + last.size + GUARD

    def thing(self, part: str) -> str:
        """Return the name of a function for messages."""
        return f"{self.name}.{part}: {self._functions[part].__qualname__}"

    def __call__(self, q: Vector, u: Vector) -> dict[str, Any]:
        """Return the outputs of all functions of the body at t = 0, q and u, by the names of the functions.

        Raises
        ------
        InvalidInput
            A function wrote beyond its size, read beyond the coordinates, failed, or gave a number that is not finite.
        """
        out = np.full(self._size, _SENTINEL)
        for part, start in self.places:
            out[start : start + part.size] = 0.0
        beyond = np.full(GUARD, np.nan)
        where = f"at q = {q.tolist()}, u = {u.tolist()}"
        try:
            self._call(0.0, np.concatenate([q, beyond]), np.concatenate([u, beyond]), out)
        except (ArithmeticError, LookupError, TypeError, ValueError) as error:
            # only functions that run uncompiled raise these exceptions
            raise InvalidInput(
                f"{self.name}", f"must have functions that do not fail {where}", error, "Look at its functions."
            ) from error
        found = {}
        for part, start in self.places:
            end = start + part.size
            around = np.concatenate([out[start - GUARD : start], out[end : end + GUARD]])
            if np.any(around != _SENTINEL):
                raise InvalidInput(
                    self.thing(part.name),
                    f"must write {part.size} numbers",
                    "written outside of these",
                    "Count rows and columns; indices start at 0.",
                )
            values = out[start:end]
            if not np.all(np.isfinite(values)):
                raise InvalidInput(
                    self.thing(part.name),
                    f"must give finite numbers {where}",
                    values.tolist(),
                    "Look for a division by zero, a root of a negative number, an index beyond the coordinates.",
                )
            found[part.name] = values.copy()
        return found
