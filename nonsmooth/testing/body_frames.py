"""Properties of the frames of a body: motion, Jacobian and biases belong together."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces import Body
from nonsmooth.testing import block
from nonsmooth.testing.block import Block, state, state_space, stepped, written
from nonsmooth.testing.draws import Case
from nonsmooth.testing.examine import Trial, examine
from nonsmooth.testing.property import Row

Array = NDArray[np.float64]
_DRAWS = 12
_SAME = 1e-6
_NOISE = 1e-12
_STEP = 1e-3
"""Step of the differences, in units of the shortest time of the motion."""


def frame_rows(body: Body) -> list[Row]:
    """Return the properties of a body's frames."""

    def row(name: str, says: str, trial: Trial) -> Row:
        return name, says, lambda: examine(name, [body], state_space(body), trial, _DRAWS)

    rows = [
        row("rotation", "the axes of every frame are a rotation matrix", _rotation),
        row("velocity", "velocity and angular velocity of every frame are derivatives of its pose, by differences", _velocity),
        row("acceleration", "the biases are the derivatives of the velocities while u' = 0, by differences", _acceleration),
    ]  # fmt: skip
    if body.n_u > 0:
        rows.append(row("jacobian", "the Jacobian is the derivative of the velocities by u", _jacobian))
    return rows


def _look(body: Body, t: float, q: Array, u: Array) -> Block:
    return Block(body, written(body, block.compiled(body), t, q, u))


def _rotation(body: Body, case: Case) -> str:
    here = _look(body, *state(body, case))
    for i in range(len(body.frames)):
        axes = here.frame(i)[3:12].reshape(3, 3)
        if not np.allclose(axes.T @ axes, np.eye(3), rtol=0.0, atol=1e-9) or np.linalg.det(axes) < 0.0:
            return f"the axes of frame {i} are {axes.tolist()}"
    return ""


def _time(body: Body, q: Array, u: Array) -> float:
    """Return a short time, in which neither a driven motion nor the body gets far."""
    q_scale, u_scale = body.scales
    rates = np.abs(_look(body, 0.0, q, u).rates) / q_scale if body.n_q else np.zeros(1)
    return _STEP / max(1.0 / body.time_scale, float(np.max(rates, initial=0.0)), 1e-3)


def _slope(body: Body, case: Case, part: Callable[[Block], Array]) -> tuple[Array, float]:
    """Return the derivative in time of what the block says, while u' = 0, and what counts as none."""
    t, q, u = state(body, case)
    dt = _time(body, q, u)

    def at(i: int) -> Array:
        moved = q
        if body.n_q:
            # the middle rule, once: exact enough for differences of fourth order over so short a time
            half = stepped(body, q, _look(body, t, q, u).rates, 0.5 * i * dt)
            third = stepped(body, q, _look(body, t + 0.5 * i * dt, half, u).rates, 0.5 * i * dt)
            slopes = [_look(body, t, q, u).rates, _look(body, t, half, u).rates, _look(body, t, third, u).rates]
            last = stepped(body, q, slopes[2], i * dt)
            slopes.append(_look(body, t, last, u).rates)
            moved = stepped(body, q, (slopes[0] + 2.0 * slopes[1] + 2.0 * slopes[2] + slopes[3]) / 6.0, i * dt)
        return np.array(part(_look(body, t + i * dt, moved, u)))

    near, far = (at(1), at(-1)), (at(2), at(-2))
    noise = _NOISE * max(float(np.max(np.abs(values))) for values in near) / dt
    return np.asarray((8.0 * (near[0] - near[1]) - (far[0] - far[1])) / (12.0 * dt)), noise


def _velocity(body: Body, case: Case) -> str:
    here = _look(body, *state(body, case))
    for i in range(len(body.frames)):
        slope, noise = _slope(body, case, lambda b, i=i: b.frame(i)[:12])  # type: ignore[misc]
        frame = here.frame(i)
        spin = slope[3:].reshape(3, 3) @ frame[3:12].reshape(3, 3).T
        found = np.append(
            slope[:3], 0.5 * np.array([spin[2, 1] - spin[1, 2], spin[0, 2] - spin[2, 0], spin[1, 0] - spin[0, 1]])
        )
        wrong = _compare(frame[12:18], found, ("velocity", "angular velocity"), i, noise)
        if wrong:
            return wrong
    return ""


def _acceleration(body: Body, case: Case) -> str:
    here = _look(body, *state(body, case))
    for i in range(len(body.frames)):
        found, noise = _slope(body, case, lambda b, i=i: b.frame(i)[12:18])  # type: ignore[misc]
        wrong = _compare(here.frame(i)[18:24], found, ("acceleration bias", "angular bias"), i, noise)
        if wrong:
            return wrong
    return ""


def _compare(given: Array, found: Array, names: tuple[str, str], frame: int, noise: float) -> str:
    for name, part in zip(names, (slice(0, 3), slice(3, 6)), strict=True):
        if np.max(np.abs(given[part] - found[part])) > _SAME * float(np.max(np.abs(found[part]))) + noise:
            return f"{name} of frame {frame} is {given[part].tolist()}, the differences give {found[part].tolist()}"
    return ""


def _jacobian(body: Body, case: Case) -> str:
    t, q, u = state(body, case)
    here, still = _look(body, t, q, u), _look(body, t, q, np.zeros(body.n_u))
    for i in range(len(body.frames)):
        predicted = still.frame(i)[12:18] + here.jacobian(i) @ u
        given = here.frame(i)[12:18]
        if np.max(np.abs(given - predicted)) > 1e-9 * (float(np.max(np.abs(given))) + float(np.max(np.abs(predicted)))):
            return f"frame {i} moves at {given.tolist()}, Jacobian times u is {predicted.tolist()}"
    return ""
