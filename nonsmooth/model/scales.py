"""Sizes of a system, from which its engine chooses tolerances."""

from __future__ import annotations

import math

from nonsmooth.interfaces import Body
from nonsmooth.interfaces.scales import EARTH, Scales
from nonsmooth.system.system import System


def scales_of(system: System) -> Scales:
    """Size of the smallest free body, typical acceleration, and shortest time of the prescribed motions of a system.

    Free bodies without contacts count only if no free body has one.

    The acceleration is the largest of three: gravity; v^2 / L of each free body, with its speed v at the start and its
    size L; and L / T^2, with the shortest time T of the prescribed motions. It is at most that of a fall on Earth. It
    is that of a fall on Earth, too, if all three are zero or the system has loads: the speeds are unknown then.
    """
    free = [body for body in system.bodies if body.n_u > 0]
    in_contact = {id(body) for row in system.contacts.rows for body in row.bodies}
    length = min(map(_size, [body for body in free if id(body) in in_contact] or free), default=1.0)
    speeds = [_speed(system, body) ** 2 / _size(body) for body in free]
    found = max(math.hypot(*system.gravity), length / system.time_scale**2, *speeds)
    is_known = found > 0.0 and not system.loads
    return Scales(length, min(EARTH, found) if is_known else EARTH, system.time_scale)


def _size(body: Body) -> float:
    """Size of a free body [m]: the least scale of the lengths among its coordinates, or else its length scale."""
    scales = [scale for scale, (_, unit) in zip(body.scales[0].tolist(), body.q_labels, strict=True) if unit == "m"]
    return float(min(scales, default=body.length_scale))


def _speed(system: System, body: Body) -> float:
    """Largest speed of a free body at the start [m/s]; an angular velocity counts with the size of the body."""
    factors = {"m/s": 1.0, "rad/s": _size(body)}
    rates = zip(system.start(body)[1].tolist(), body.u_labels, strict=True)
    return max(abs(rate) * factors.get(unit, 0.0) for rate, (_, unit) in rates)
