"""Sizes of a system, from which its engine chooses tolerances."""

from __future__ import annotations

import math

from nonsmooth.engine.numerics.tolerances import LARGEST_RELATIVE_GAP
from nonsmooth.errors import InvalidInput
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
    sizes = {id(body): _size(body) for body in system.bodies if body.n_u > 0}
    length = min((sizes[id(body)] for body in _counting(system)), default=1.0)
    found = max(math.hypot(*system.gravity), length / system.time_scale / system.time_scale)
    for body in system.bodies:
        if body.n_u > 0:
            size = sizes[id(body)]
            speed = _speed(system, body, size)
            # the square of a speed that is too large would raise an error of Python
            found = max(found, speed / size * speed)
    is_known = found > 0.0 and not system.loads
    return Scales(length, min(EARTH, found) if is_known else EARTH, system.time_scale)


def check_gap_tolerance(system: System, gap: float) -> None:
    """Check that the gap tolerance [m] is small against the smallest free body.

    Raises
    ------
    InvalidInput
        If the user gave a tolerance that is too large for the body.
    """
    smallest = min(_counting(system), key=_size, default=None)
    if smallest is not None and gap > LARGEST_RELATIVE_GAP * _size(smallest):
        raise InvalidInput(
            "engine: gap_tolerance",
            f"must be at most {LARGEST_RELATIVE_GAP:g} of the smallest body, {system.name_of(smallest)!r} of "
            f"{_size(smallest):.3g} m",
            gap,
            "Leave it out: the default follows from the size of the bodies.",
        )


def _counting(system: System) -> list[Body]:
    """Free bodies whose size counts: those with contacts, or all if none has one."""
    free = [body for body in system.bodies if body.n_u > 0]
    in_contact = {id(body) for row in system.contacts.rows for body in row.bodies}
    return [body for body in free if id(body) in in_contact] or free


def _size(body: Body) -> float:
    """Size of a free body [m]: the least scale of the lengths among its coordinates, or else its length scale."""
    scales = [float(scale) for scale, (_, unit) in zip(body.scales[0], body.q_labels, strict=True) if unit == "m"]
    return min(scales, default=body.length_scale)


def _speed(system: System, body: Body, size: float) -> float:
    """Largest speed of a free body at the start [m/s]; an angular velocity counts with the ``size`` of the body [m]."""
    factors = {"m/s": 1.0, "rad/s": size}
    rates = zip(system.start(body)[1].tolist(), body.u_labels, strict=True)
    return max(abs(float(rate)) * factors.get(unit, 0.0) for rate, (_, unit) in rates)
