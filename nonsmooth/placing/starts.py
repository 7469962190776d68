"""Named starts: a body is moved until it touches another one, or to a height above it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from nonsmooth.checks import check_kind, is_finite
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.body import Vector
from nonsmooth.placing.line import Line
from nonsmooth.placing.probe import Probe
from nonsmooth.system.system import System
from nonsmooth.vectors import direction

_ROUND_OFF = 1e-9
_SYSTEM = "Make it by nonsmooth.System([...])."


def touching(system: System, body: Body, *, direction: Sequence[float] | None = None, **start: Any) -> None:
    """Move a body from its start, without turning it, until its smallest gap is zero.

    It keeps its orientation and its velocities.

    Parameters
    ----------
    system : System
        The system, with starts of its bodies and declared contacts.
    body : Body
        The body to move; the others stay where they start.
    direction : sequence of float, optional
        Vector along which to move it, shape [3], of any length; by default along gravity.  A body that overlaps moves
        the opposite way.
    **start : object
        Another start from which to move it: keyword arguments of :meth:`System.place`, such as ``position`` and
        ``velocity``.  Those that are left out then have their defaults.  Without any, the body keeps the start that it
        has.

    Raises
    ------
    InvalidInput
        If the body is driven, has no contact, cannot move in this direction, or touches nothing there.
    """
    _move(system, body, 0.0, direction, start)


def at_height(
    system: System, body: Body, height: float, *, direction: Sequence[float] | None = None, **start: Any
) -> None:
    """Move a body as :func:`touching` does, until its smallest gap is ``height`` [m].

    For example ``at_height(system, coin, 0.1)`` after ``system.place(coin, angular_velocity=(0, 0, 30))``.

    Raises
    ------
    InvalidInput
        As :func:`touching`, or if the height is negative.
    """
    if not (is_finite(height) and height >= 0.0):
        raise InvalidInput(
            "at_height: height", "must be finite and not negative", height, "It is the smallest gap [m]."
        )
    _move(system, body, float(height), direction, start)


def resting(system: System, body: Body, *, direction: Sequence[float] | None = None, **start: Any) -> None:
    """Move a body as :func:`touching` does, and set it at rest relative to the body that it touches at t = 0.

    It gets the velocity and angular velocity of a point fixed to that body, so that no contact between them slips.

    Raises
    ------
    InvalidInput
        As :func:`touching`, or if the start has velocities, or the body cannot follow the one that it touches.
    """
    check_kind("resting: system", system, System, _SYSTEM)
    u = body.state(**start)[1] if start else system.start(body)[1]
    if np.any(u != 0.0):
        raise InvalidInput(
            f"resting {system.name_of(body)!r}",
            "must not be given velocities",
            start or u.tolist(),
            "Use touching(...) to give some.",
        )
    _move(system, body, 0.0, direction, start)
    probe = Probe.of(system, body)
    gaps = probe.gaps()
    # the body was moved until solids meet, to a tolerance. So the gap of a touching contact need not be exactly zero:
    # a contact touches if its gap equals the smallest gap (or 0, if this gap is negative) within round-off
    touched = gaps <= max(float(np.min(gaps)), 0.0) + _ROUND_OFF * max(row.size for row in probe.contacts.rows)
    contact = probe.contacts[int(np.argmin(gaps))]
    own, other = (0, 1) if contact.first is body else (1, 0)
    carrier = Probe.of(system, (contact.first, contact.second)[other]).frame(contact.frames[other])
    frame = probe.frame(contact.frames[own])
    turn = carrier[15:18]
    twist = np.concatenate([carrier[12:15] + np.cross(turn, frame[:3] - carrier[:3]), turn])
    u = np.linalg.lstsq(probe.jacobian(contact.frames[own]), twist, rcond=None)[0]
    rates = probe.rates(u)[touched]
    # of the body there, and of its farthest points by its rotation
    speed = float(np.linalg.norm(twist[:3]) + np.linalg.norm(turn) * body.length_scale)
    if np.max(np.abs(rates)) > _ROUND_OFF * speed:
        raise InvalidInput(
            f"resting {system.name_of(body)!r}",
            f"must be able to follow {system.name_of((contact.first, contact.second)[other])!r}, which it touches",
            rates.tolist(),
            "These are the gap rate and the slip velocity that remain [m/s]; use touching(...) and give a velocity.",
        )
    system.set_start(body, probe.q, u)


def _move(system: System, body: Body, height: float, direction: Sequence[float] | None, start: dict[str, Any]) -> None:
    check_kind("placing: system", system, System, _SYSTEM)
    way = _unit(system, direction)
    before = system.start(body)
    name = f"placing {system.name_of(body)!r}"
    if start:
        system.place(body, **start)
    try:
        if body.n_u == 0:
            raise InvalidInput(name, "needs a body that can be placed", "driven", "Place the other body.")
        probe = Probe.of(system, body)
        if not probe.contacts:
            raise InvalidInput(name, "needs a contact of this body", 0, "Declare it with system.contact(...) first.")
        u = probe.u.copy()
        system.set_start(body, Line(probe, way, height).met(), u)
    except InvalidInput:
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


def turned_about(axis: Sequence[float], angle: float) -> tuple[float, float, float, float]:
    """Unit quaternion of a rotation about an axis, for ``System.place`` and other orientations.

    Parameters
    ----------
    axis : sequence of float
        Unit vector of the axis, shape [3].
    angle : float
        Angle of the rotation [rad], by the right-hand rule.

    Returns
    -------
    tuple of float
        The unit quaternion (cos(angle / 2), axis * sin(angle / 2)), scalar first.

    Raises
    ------
    InvalidInput
        If the axis is not a unit vector, or the angle is not finite.
    """
    x, y, z = direction("turned_about: axis", axis)
    if not is_finite(angle):
        raise InvalidInput("turned_about: angle", "must be a finite number", angle, "Give it in [rad].")
    s = math.sin(0.5 * angle)
    return math.cos(0.5 * angle), x * s, y * s, z * s
