"""Properties of bodies: their start, frames, mass, energy, momentum, a short run, and ballistic motion in closed form.

Each claim states a property in its docstring. It returns or raises a message if the property fails, else "" or None.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from nonsmooth.engine.memory.blocks import ACCELERATION, POSITION, ROTATION, SPIN, VELOCITY
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.body import UNITS_OF_Q, UNITS_OF_U
from nonsmooth.runs.simulate import simulate
from nonsmooth.system.system import System
from nonsmooth.testing.body_block import (
    OBLIQUE,
    WEIGHTLESS,
    BodyBlock,
    State,
    block_of,
    block_size,
    offered,
    plain,
    state_at,
    state_of,
    stepped,
)
from nonsmooth.testing.claims import GIVEN, Claims, claim, rows
from nonsmooth.testing.differences import rotation_fault, slope, slope_fault, smooth_slope, spin_of
from nonsmooth.testing.functions import (
    CheckedFunction,
    all_rows,
    compiled_caller,
    left_over,
    place_of_function,
    written,
)
from nonsmooth.testing.inputs import draws
from nonsmooth.testing.outcome import Broken, NotChecked, Row
from nonsmooth.testing.property import Property, properties
from nonsmooth.testing.shape import require_look
from nonsmooth.types import Array

_DRAWS = 12
_UNKNOWN = "no_such_word"
_SAME = 1e-6
_STEP = 1e-3
"""Time step of the difference quotients with which derivatives are compared, in units of the shortest time in which a
coordinate or velocity changes by its scale. So the values hardly change in a step."""
_SLOWEST = 1e-3
"""Lower bound of the rates of a motion [1/s], so that times derived from them are finite for a body at rest."""
_FALLS = 20
_RUN = 0.4
"""Initial state of a short run: the deviation of its coordinates and velocities from the body's default start, relative
to the largest deviation in which the body is checked."""
_TURNS = 3.0
"""Longest time after which the closed form of ballistic motion is compared, in units of the shortest time in which a
coordinate or velocity changes by its scale. The motion then has changed the body's state markedly."""
_AXES, _POSE = slice(ROTATION, VELOCITY), slice(POSITION, VELOCITY)
_EVERY, _FREE = Claims(), Claims()
"""Properties of every body, and properties of bodies with coordinates, respectively."""


def check_body(body: Body) -> list[Property]:
    """Return the properties that every body must have, each with its check of this body.

    Parameters
    ----------
    body : Body
        The body; it is checked in states near its start.
    """
    return properties(body, _rows)


def _rows(body: Body) -> list[Row]:
    has_coordinates = body.n_u > 0
    optional = {
        _unit_quaternion: has_coordinates and body.quaternion >= 0,
        _spin: has_coordinates and body.spin >= 0,
        _momentum: body.n_u == 6 and len(body.frames) == 1,
        _flight: body.flight is not None,
    }
    claims = [*_EVERY, *_FREE * has_coordinates, *(one for one, is_asked in optional.items() if is_asked)]
    functions = [name for name in ("evaluator", "flight") if getattr(body, name)]
    found = rows(claims, lambda: [body], _DRAWS, [state_of(body)])
    return all_rows(body, lambda: [_function(body, name) for name in functions], found)


def _function(body: Body, name: str) -> CheckedFunction:
    size = block_size(body) if name == "evaluator" else body.n_q + body.n_u
    inputs = [(f"t = {case['t']:.3g}", state_at(body, case)) for case in draws([state_of(body)], 6)]
    return CheckedFunction(body, name, "body", offered(body), inputs, size)


@_EVERY.claim()
def _start(body: Body) -> None:
    """The start has as many numbers as the body declares, each with a unit, and unknown keywords are refused."""
    q, u = body.state()
    sizes, labels, known = (body.n_q, body.n_u), (body.q_labels, body.u_labels), (UNITS_OF_Q, UNITS_OF_U)
    columns = zip("qu", sizes, (q, u), body.state(), body.scales, labels, known, strict=True)
    for name, size, given, again, scale, named, units in columns:
        if not np.array_equal(given, again):
            both = f"{np.asarray(given).tolist()} and {np.asarray(again).tolist()}"
            raise Broken(f"`state` gives another start each time: {place_of_function(type(body).state)}", name, both)
        if np.shape(given) != (size,) or not np.all(np.isfinite(given)):
            raise Broken(f"`state` must give {size} finite numbers", name, given)
        if np.shape(scale) != (size,) or not np.all(np.isfinite(scale)) or not np.all(np.asarray(scale) > 0.0):
            raise Broken(f"`scales` must give {size} positive numbers", name, scale)
        wrong = [label for label in named if not label[0] or label[1] not in units]
        if wrong or len(dict(named)) < len(named):
            reason = f"`{name}_labels` must give each number a name of its own and a unit of {units}"
            raise Broken(reason, f"{name}_labels", named)
    if body.quaternion >= 0 and abs(float(np.linalg.norm(q[body.quaternion : body.quaternion + 4])) - 1.0) > 1e-12:
        raise Broken("the quaternion has no unit length", "quaternion", q.tolist())
    if not body.time_scale > 0.0:
        raise Broken("it must be positive", "time_scale", body.time_scale)
    try:
        body.state(**{_UNKNOWN: 0.0})
    except InvalidInput:
        return
    raise Broken("`state` takes words that it does not know", _UNKNOWN, 0.0)


@_EVERY.claim(GIVEN)
def _writes_its_block(body: Body, at: State) -> str:
    """The evaluator writes every number that can be non-zero, whatever the block held, and nothing beyond the block."""
    call, (t, q, u), (start, rest) = plain(body), at, body.state()
    # a second state, which is evaluated into the block first. A number that the evaluator does not write for ``at``
    # then keeps its value from the second state, and the comparison finds it
    before = 1.0 - t, start - 0.9 * (q - start) + 0.1, rest - 0.9 * (u - rest) + 0.1
    return left_over(lambda out: call(*at, out), lambda out: call(*before, out), block_size(body))


@_EVERY.claim()
def _sketch(body: Body) -> None:
    """The sketch of the body can be drawn."""
    sketch = body.sketch
    if not isinstance(sketch, Sequence) or len(sketch) > len(body.frames):
        raise Broken(f"it must be a look for each of {len(body.frames)} frames at most", "sketch", sketch)
    for look in sketch:
        require_look("sketch", look)
    q = body.state()[0]
    shape = np.shape(body.strokes(q))
    if len(shape) != 3 or shape[1:] != (2, 3) or np.shape(body.strokes(q + 0.01)) != shape:
        raise Broken("it must give the ends of the same number of lines at all q, shape [n, 2, 3]", "strokes", shape)
    if not np.all(np.isfinite(body.strokes(q))):
        raise Broken("ends of lines must be finite [m]", "strokes", body.strokes(q))


def _rate(body: Body, here: BodyBlock) -> float:
    """Return the largest rate of the coordinates, in units of their scales [1/s]."""
    return max(float(np.max(np.abs(here.rates) / body.scales[0], initial=0.0)), _SLOWEST)


@_EVERY.claim(GIVEN)
def _rotation(body: Body, at: State) -> str:
    """The axes of every frame are a rotation matrix."""
    here = block_of(body, at)
    for i in range(len(body.frames)):
        if fault := rotation_fault(here.frames[i][_AXES]):
            return f"{fault}, of frame {i}"
    return ""


def _frame_slope(body: Body, at: State, i: int, part: slice) -> tuple[Array, float]:
    """Return the derivative in time of a part of a frame while u' = 0, and a bound of the derivative's error."""
    t, q, u = at
    dt = _STEP / max(1.0 / body.time_scale, _rate(body, block_of(body, (0.0, q, u))) if body.n_q else _SLOWEST)

    def rates(time: float, place: Array) -> Array:
        return block_of(body, (time, place, u)).rates

    def after(step: float) -> Array:
        """Return q after a Runge-Kutta step of order 4, accurate enough for differences of order 4."""
        first = rates(t, q)
        second = rates(t + 0.5 * step, stepped(body, q, first, 0.5 * step))
        third = rates(t + 0.5 * step, stepped(body, q, second, 0.5 * step))
        fourth = rates(t + step, stepped(body, q, third, step))
        return stepped(body, q, (first + 2.0 * second + 2.0 * third + fourth) / 6.0, step)

    def value(step: float) -> Array:
        return np.array(block_of(body, (t + step, after(step) if body.n_q else q, u)).frames[i, part])

    return slope(value, dt)


@_EVERY.claim(GIVEN)
def _velocity(body: Body, at: State) -> str:
    """Velocity and angular velocity of every frame are the time derivatives of its position and its rotation."""
    for i, frame in enumerate(block_of(body, at).frames):
        rates, known = _frame_slope(body, at, i, _POSE)
        spin = spin_of(rates[ROTATION:], frame[_AXES])
        fault = slope_fault(f"velocity of frame {i}", frame[VELOCITY:SPIN], rates[:ROTATION], known)
        if fault := fault or slope_fault(f"angular velocity of frame {i}", frame[SPIN:ACCELERATION], spin, known):
            return fault
    return ""


@_EVERY.claim(GIVEN)
def _acceleration(body: Body, at: State) -> str:
    """The acceleration biases of every frame are the time derivatives of its velocities while u' = 0."""
    for i, frame in enumerate(block_of(body, at).frames):
        found, known = _frame_slope(body, at, i, slice(VELOCITY, ACCELERATION))
        if fault := slope_fault(f"acceleration biases of frame {i}", frame[ACCELERATION:], found, known):
            return fault
    return ""


@_FREE.claim(GIVEN)
def _jacobian(body: Body, at: State) -> str:
    """The Jacobian of every frame is the derivative of its velocities by u."""
    t, q, u = at
    here, still = block_of(body, at), block_of(body, (t, q, np.zeros(body.n_u)))
    for i in range(len(body.frames)):
        given, rest = (block.frames[i][VELOCITY:ACCELERATION] for block in (here, still))
        predicted = rest + here.jacobians[i] @ u
        if np.max(np.abs(given - predicted)) > 1e-9 * float(np.max(np.abs(given)) + np.max(np.abs(predicted))):
            return f"frame {i} moves at {given.tolist()}, Jacobian times u is {predicted.tolist()}"
    return ""


@_FREE.claim(GIVEN)
def _mass_matrix(body: Body, at: State) -> str:
    """M is symmetric and positive definite."""
    inverse = block_of(body, at).inverse
    # entries may have different units: they are scaled by the square roots of the diagonal
    size = np.sqrt(np.abs(np.diag(inverse)))
    if not np.all(size > 0.0):
        return f"the diagonal of M^-1 is {np.diag(inverse).tolist()}"
    scaled = inverse / np.outer(size, size)
    if np.max(np.abs(scaled - scaled.T)) > 1e-12:
        return f"M^-1 is not symmetric: {inverse.tolist()}"
    least = float(np.linalg.eigvalsh(scaled)[0])
    return f"M^-1 is not positive definite: {inverse.tolist()}" if least <= 1e-14 else ""


@_FREE.claim(GIVEN)
def _kinetic_energy(body: Body, at: State) -> str:
    """The kinetic energy that the body gives is u . M u / 2."""
    here, u = block_of(body, at), at[2]
    given, expected = float(here.energy[0]), 0.5 * float(u @ np.linalg.solve(here.inverse, u))
    if abs(given - expected) > 1e-8 * expected + 1e-300:
        return f"it is {given:g} J, u . M u / 2 is {expected:g} J"
    return ""


def _along(body: Body, at: State, gravity: Mapping[str, float], value: Callable[[BodyBlock, Array], Array]) -> Array:
    """Return the rate of change of ``value(block, u)`` during free motion of the body.

    Prescribed motions inside the body are frozen at the time of the state ``at``.
    """
    t, q, u = at
    here = block_of(body, at, gravity)
    acceleration = here.inverse @ here.force
    speed = max(_rate(body, here), float(np.max(np.abs(acceleration) / body.scales[1])))

    def after(dt: float) -> Array:
        # a straight step is enough for a first derivative
        moved, faster = q + dt * here.rates, u + dt * acceleration
        return np.array(value(block_of(body, (t, moved, faster), gravity), faster))

    return smooth_slope(after, _STEP / speed)


@_FREE.claim(GIVEN)
def _energy_in_free_flight(body: Body, at: State) -> str:
    """In free flight the sum of kinetic and potential energy is constant."""
    rates, here, u = _along(body, at, OBLIQUE, lambda b, u: b.energy), block_of(body, at), at[2]
    size = float(np.sum(np.abs(rates)) + np.abs(u) @ np.abs(here.force) + 1e-9 * np.sum(np.abs(here.energy)))
    if abs(float(np.sum(rates))) > _SAME * size:
        return f"the kinetic energy changes by {rates[0]:g} W, the potential by {rates[1]:g} W"
    return ""


@_FREE.claim()
def _free_flight(body: Body) -> None:
    """In a short free run of the body, at most 1e-7 of its energy is unaccounted for."""
    numbers = {one.name: _RUN * one.high for one in state_of(body).numbers}
    _, q, u = state_at(body, numbers | {"t": 0.0})
    system = System([body], gravity=9.81)
    system.set_start(body, q, u)
    duration = min(_FALLS / _rate(body, block_of(body, (0.0, q, u))), 1.0)
    residual = simulate(system, duration, sample_interval=duration, progress=None).energy.residual
    if not (math.isfinite(residual) and residual <= 1e-7):
        raise Broken(f"after {duration:g} s the account leaves {residual:g} of the energy unexplained")


def _quaternion(body: Body) -> slice:
    return slice(body.quaternion, body.quaternion + 4)


@claim(GIVEN)
def _unit_quaternion(body: Body, at: State) -> str:
    """The rates that the body gives for its unit quaternion keep the length of the quaternion constant."""
    part = _quaternion(body)
    rates = block_of(body, at).rates[part]
    change = float(at[1][part] @ rates)
    return f"its length changes at {change:g} 1/s" if abs(change) > 1e-9 * float(np.linalg.norm(rates)) else ""


@claim(GIVEN)
def _spin(body: Body, at: State) -> str:
    """The rates of the quaternion are half its product with (0, spin)."""
    (a, *axis), spin = at[1][_quaternion(body)], at[2][body.spin : body.spin + 3]
    expected = 0.5 * np.append(-np.dot(axis, spin), a * spin + np.cross(axis, spin))
    rates = block_of(body, at).rates[_quaternion(body)]
    wrong = float(np.max(np.abs(rates - expected)))
    return f"they are {rates.tolist()}" if wrong > 1e-9 * float(np.linalg.norm(spin)) else ""


@claim(GIVEN)
def _momentum(body: Body, at: State) -> str:
    """Without gravity, momentum and angular momentum are constant in free flight."""

    def value(b: BodyBlock, u: Array) -> Array:
        # M u = J^T (p, L), L about the origin of the frame
        wrench = np.linalg.solve(b.jacobians[0].T, np.linalg.inv(b.inverse) @ u)
        return np.append(wrench[:3], wrench[3:] + np.cross(b.frames[0][:3], wrench[:3]))

    here = block_of(body, at, WEIGHTLESS)
    if abs(np.linalg.det(here.jacobians[0])) < 1e-12:
        raise NotChecked(f"{type(body).__name__}: its frame does not move freely")
    change, total = _along(body, at, WEIGHTLESS, value), value(here, at[2])
    for name, part in (("momentum", slice(0, 3)), ("angular momentum", slice(3, 6))):
        if np.max(np.abs(change[part])) > _SAME * _rate(body, here) * float(np.max(np.abs(total[part]))):
            return f"the {name} {total[part].tolist()} changes by {change[part].tolist()} per second"
    return ""


def _change(body: Body, t: float, y: Array) -> Array:
    """Return dq/dt and du/dt of the free motion, shape [n_q + n_u]."""
    here = block_of(body, (t, y[: body.n_q], y[body.n_q :]))
    return np.append(here.rates, here.inverse @ here.force)


@claim(GIVEN)
def _flight(body: Body, at: State) -> str:
    """Ballistic motion in closed form begins at the given start and follows the equations of motion."""
    t, q, u = at
    assert body.flight is not None
    call = compiled_caller(body.flight, "body", offered(body), type(body).__name__)
    scale, start, n = np.concatenate(body.scales), np.append(q, u), body.n_q + body.n_u
    speed = max(float(np.max(np.abs(_change(body, t, start)) / (scale + np.abs(start)))), _SLOWEST)

    def flown(elapsed: float) -> Array:
        return written(lambda out: call(elapsed, q.copy(), u.copy(), out), n)[:n]

    if np.max(np.abs(flown(0.0) - start) / (scale + np.abs(start))) > _SAME:
        return f"after no time it is at {flown(0.0).tolist()}"
    for part in (0.3, 1.0):
        elapsed = part * _TURNS / speed
        found = smooth_slope(lambda dt, since=elapsed: flown(since + dt), _STEP / speed)  # type: ignore[misc]
        expected = _change(body, t + elapsed, flown(elapsed))
        wrong = np.abs(found - expected) / (speed * (scale + np.abs(flown(elapsed))))
        if not np.max(wrong) <= _SAME:
            i = int(np.argmax(wrong))
            return f"after {elapsed:g} s number {i} changes by {found[i]:g} per second, not by {expected[i]:g}"
    return ""
