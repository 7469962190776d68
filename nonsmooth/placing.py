"""Named starts: a body is moved until it touches, or to a height over what it would touch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from nonsmooth.engine.kernel import call_room
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.body import Vector
from nonsmooth.model.assembly import lay_out
from nonsmooth.model.layout import FRAME
from nonsmooth.model.model import Model
from nonsmooth.model.options import Options
from nonsmooth.system.system import System

_STEPS = 1000
_FARTHEST = 1e6
_ROUND_OFF = 1e-9


def touching(system: System, body: Body, *, direction: Sequence[float] | None = None, **start: Any) -> None:
    """Place a body as ``start`` says, then move it, without turning it, until its smallest gap is zero.

    Parameters
    ----------
    system : System
        Its bodies placed, its contacts declared.
    body : Body
        The body to move; the others stay where they start.
    direction : sequence of float, optional
        Where to move it [m, shape (3)]; by default along gravity.  A body that overlaps moves the other way.
    **start : object
        The words of the body's ``state``.

    Raises
    ------
    InvalidInput
        If the body is driven or has no contact, cannot move this way, or touches nothing there.
    """
    _move(system, body, 0.0, direction, start)


def at_height(
    system: System, body: Body, height: float, *, direction: Sequence[float] | None = None, **start: Any
) -> None:
    """Place a body as :func:`touching` does, with ``height`` [m] for its smallest gap.

    Raises
    ------
    InvalidInput
        As :func:`touching`, or if the height is negative.
    """
    if not 0.0 <= height < np.inf:
        raise InvalidInput("at_height: height", "must not be negative", height, "It is the smallest gap [m].")
    _move(system, body, float(height), direction, start)


def resting(system: System, body: Body, *, direction: Sequence[float] | None = None, **start: Any) -> None:
    """Place a body as :func:`touching` does, with the velocity that the body which it touches has at t = 0.

    It moves and turns as if it were fixed to that body, so that no contact between them slips.

    Raises
    ------
    InvalidInput
        As :func:`touching`, or if ``start`` has velocities, or the body cannot follow the one that it touches.
    """
    if np.any(body.state(**start)[1] != 0.0):
        raise InvalidInput(
            f"resting {type(body).__name__}", "must not be given velocities", start, "Use touching(...) to give some."
        )
    _move(system, body, 0.0, direction, start)
    probe = _probe(system, body)
    gaps = probe.gaps()
    touched = gaps <= _ROUND_OFF * max(system.contacts[i].size for i in probe.contacts)
    contact = system.contacts[probe.contacts[int(np.argmin(gaps))]]
    own, other = (0, 1) if contact.first is body else (1, 0)
    carrier = _probe(system, (contact.first, contact.second)[other]).frame(contact.frames[other])
    frame = probe.frame(contact.frames[own])
    turn = carrier[15:18]
    twist = np.concatenate([carrier[12:15] + np.cross(turn, frame[:3] - carrier[:3]), turn])
    u = np.linalg.lstsq(probe.jacobian(contact.frames[own]), twist, rcond=None)[0]
    rates = probe.rates(u)[touched]
    if np.max(np.abs(rates)) > _ROUND_OFF * (1.0 + float(np.max(np.abs(twist)))):
        raise InvalidInput(
            f"resting {type(body).__name__}",
            f"must be able to follow the {type((contact.first, contact.second)[other]).__name__} that it touches",
            rates.tolist(),
            "These are the gap rate and the slip velocity that remain [m/s]; use touching(...) and give a velocity.",
        )
    system.set_start(body, probe.q, u)


@dataclass(frozen=True)
class _Probe:
    """One body of a laid-out system, moved by hand."""

    model: Model
    body: Body
    number: int
    contacts: tuple[int, ...]

    def _part(self, name: str, first: int, size: int) -> Vector:
        start = int(self.model.memory.array(f"body_{name}", self.number + 1)[self.number]) + first
        return self.model.memory.floats[start : start + size]

    def _state(self, offset: int, name: str, size: int) -> Vector:
        start = offset + int(self.model.memory.array(f"body_{name}", self.number + 1)[self.number])
        return self.model.memory.array("y", self.model.n_y)[start : start + size]

    @property
    def q(self) -> Vector:
        return self._state(0, "q", self.body.n_q)

    @property
    def u(self) -> Vector:
        return self._state(self.model.n_q, "u", self.body.n_u)

    def frame(self, number: int) -> Vector:
        call_room("evaluate_at", self.model.memory)
        return self._part("out", number * (FRAME + 6 * self.body.n_u), FRAME).copy()

    def jacobian(self, number: int) -> Vector:
        first = number * (FRAME + 6 * self.body.n_u) + FRAME
        return self._part("out", first, 6 * self.body.n_u).reshape(6, self.body.n_u).copy()

    def coordinate_rates(self, u: Vector) -> Vector:
        kept = self.u.copy()
        self.u[:] = u
        call_room("evaluate_at", self.model.memory)
        self.u[:] = kept
        return self._part("tail", 0, self.body.n_q).copy()

    def gaps(self) -> Vector:
        return np.asarray(self.model.gaps()[list(self.contacts)])

    def rates(self, u: Vector) -> Vector:
        self.u[:] = u
        call_room("evaluate_at", self.model.memory)
        n = len(self.model.system.contacts)
        return self.model.memory.array("rate", 3 * n).reshape(n, 3)[list(self.contacts)].copy()


def _probe(system: System, body: Body) -> _Probe:
    number = next(i for i, other in enumerate(system.bodies) if other is body)
    contacts = tuple(i for i, one in enumerate(system.contacts) if one.first is body or one.second is body)
    return _Probe(lay_out(system, Options()), body, number, contacts)


def _move(system: System, body: Body, height: float, direction: Sequence[float] | None, start: dict[str, Any]) -> None:
    name = type(body).__name__
    way = _unit(system, direction)
    before = system.start(body) if any(other is body for other in system.bodies) else None
    system.place(body, **start)
    try:
        probe = _probe(system, body)
        if body.n_u == 0:
            raise InvalidInput(f"placing {name}", "needs a body that can be placed", name, "Place the other body.")
        if not probe.contacts:
            raise InvalidInput(
                f"placing {name}", "needs a contact of this body", 0, "Declare it with system.contact(...) first."
            )
        q, u = probe.q.copy(), probe.u.copy()
        rates = _way(probe, way)

        def over(distance: float) -> Vector:
            probe.q[:] = q + distance * rates
            return probe.gaps() - height

        system.set_start(body, q + _root(over, name, way, system) * rates, u)
    except InvalidInput:
        if before is not None:
            system.set_start(body, *before)
        raise


def _unit(system: System, direction: Sequence[float] | None) -> Vector:
    try:
        way = np.array(system.gravity if direction is None else direction, dtype=float)
    except (TypeError, ValueError):
        way = np.zeros(0)
    if way.shape != (3,) or not np.all(np.isfinite(way)) or not np.any(way):
        raise InvalidInput(
            "placing: direction",
            "must be three finite numbers, not all zero",
            system.gravity if direction is None else direction,
            "Without gravity, say where to move the body, for example direction=(0, 0, -1).",
        )
    return np.asarray(way / np.linalg.norm(way))


def _way(probe: _Probe, way: Vector) -> Vector:
    """Return the coordinate rates of a unit velocity of the body's frame along ``way``, as far as it can go there."""
    probe.frame(0)
    jacobian = probe.jacobian(0)
    u = np.linalg.lstsq(jacobian, np.concatenate([way, np.zeros(3)]), rcond=None)[0]
    twist = jacobian @ u
    speed = float(np.linalg.norm(twist[:3]))
    if speed < 1e-6 or float(np.linalg.norm(twist[3:] * max(probe.body.scales[0]))) > 1e-6 * speed:
        raise InvalidInput(
            f"placing {type(probe.body).__name__}",
            "must be able to move along the direction without turning",
            way.tolist(),
            "Give another direction.",
        )
    return probe.coordinate_rates(u / speed)


def _root(over: Callable[[float], Vector], name: str, way: Vector, system: System) -> float:
    """Return the distance at which the least of ``over`` vanishes."""
    from scipy.optimize import brentq

    gaps = over(0.0)
    first = float(np.min(gaps))
    if first == 0.0:
        return 0.0
    sign = 1.0 if first > 0.0 else -1.0
    least = _ROUND_OFF * max(contact.size for contact in system.contacts)
    distance, slopes = 0.0, np.zeros(len(gaps))
    for _ in range(_STEPS):
        # No gap falls faster than the body moves.  Those of convex shapes are convex functions of the distance, so
        # that a secant does not lead past the zero either, and it is fast where a gap falls slowly.
        falling = np.where(slopes > 0.0, np.minimum(slopes, 1.0), 1.0)
        reach = float(np.min(gaps / falling)) if sign > 0.0 else -float(np.min(gaps))
        step = sign * max(1.0001 * reach, least)
        now = over(distance + step)
        if float(np.min(now)) * first <= 0.0:
            low, high = sorted((distance, distance + step))
            tolerances = {"xtol": 1e-16 * least, "rtol": 4.0 * np.finfo(float).eps}
            return float(brentq(lambda x: float(np.min(over(x))), low, high, **tolerances))
        distance, gaps, slopes = distance + step, now, (gaps - now) / step
        if not abs(distance) < _FARTHEST * (abs(first) + least / _ROUND_OFF):
            break
    raise InvalidInput(
        f"placing {name}",
        f"must find something to touch along {(sign * way).tolist()}",
        float(np.min(gaps)),
        f"This is the smallest gap less the height after {abs(distance):.3g} m [m]; give another start or direction.",
    )
