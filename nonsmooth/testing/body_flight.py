"""Properties of the closed form in which a body may say where it flies."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces import Body
from nonsmooth.testing import block
from nonsmooth.testing.block import Block, state, state_space, written
from nonsmooth.testing.callers import Caller, compiled_caller, plain_caller
from nonsmooth.testing.draws import Case
from nonsmooth.testing.examine import examine
from nonsmooth.testing.functions import OLD, ROOM
from nonsmooth.testing.property import Row

Array = NDArray[np.float64]
_DRAWS = 12
_STEP = 1e-3
_SAME = 1e-6
_TURNS = 3.0
"""How long flights are, in units of the time in which something changes by as much as it counts."""


def plain_flight(body: Body) -> Caller:
    """Return the closed form as it stands."""
    assert body.flight is not None
    return plain_caller(body.flight, "body", block.offered(body))


def compiled_flight(body: Body) -> Caller:
    """Return the closed form, compiled."""
    assert body.flight is not None
    return compiled_caller(body.flight, "body", block.offered(body), type(body).__name__)


def flown(body: Body, call: Callable[..., Any], t: float, q: Array, u: Array) -> Array:
    """Return what the closed form writes, with some room behind it."""
    out = np.full(body.n_q + body.n_u + ROOM, OLD)
    call(t, np.array(q), np.array(u), out)
    return out


def flight_rows(body: Body) -> list[Row]:
    """Return the properties of a body that knows its flight."""
    says = "it begins where it is asked from and goes on as the equations of motion say"
    return [("flight", says, lambda: examine("flight", [body], state_space(body), _flies, _DRAWS))]


def _rates(body: Body, t: float, y: Array) -> Array:
    here = Block(body, written(body, block.compiled(body), t, y[: body.n_q], y[body.n_q :]))
    return np.append(here.rates, here.inverse @ here.force)


def _flies(body: Body, case: Case) -> str:
    t, q, u = state(body, case)
    call, n = compiled_flight(body), body.n_q + body.n_u
    scale = np.concatenate(body.scales)
    start = np.append(q, u)
    speed = max(float(np.max(np.abs(_rates(body, t, start)) / (scale + np.abs(start)))), 1e-3)

    def at(elapsed: float) -> Array:
        return flown(body, call, elapsed, q, u)

    if np.max(np.abs(at(0.0)[:n] - start) / (scale + np.abs(start))) > _SAME:
        return f"after no time it is at {at(0.0)[:n].tolist()}"
    for part in (0.3, 1.0):
        elapsed, dt = part * _TURNS / speed, _STEP / speed
        one, two, four = ((at(elapsed + i * dt) - at(elapsed - i * dt))[:n] / (2.0 * i * dt) for i in (1, 2, 4))
        # two steps of Richardson's extrapolation
        first, second = (4.0 * one - two) / 3.0, (4.0 * two - four) / 3.0
        found, expected = (16.0 * first - second) / 15.0, _rates(body, t + elapsed, at(elapsed)[:n])
        wrong = np.abs(found - expected) / (speed * (scale + np.abs(at(elapsed)[:n])))
        if not np.max(wrong) <= _SAME:
            i = int(np.argmax(wrong))
            return f"after {elapsed:g} s number {i} changes by {found[i]:g} per second, not by {expected[i]:g}"
    return ""
