"""Conformance checks of anisotropic friction: its bound is made of two half ellipses along an axis fixed to a body.

Each claim states a property in its docstring. It returns or raises a message if the property fails, else "" or None.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial.transform import Rotation

from nonsmooth.interfaces import AnisotropicFrictionLaw
from nonsmooth.system.materials import ContactLaws
from nonsmooth.testing.claims import FEWEST, Claims, claim, rows
from nonsmooth.testing.coefficient import (
    COEFFICIENT,
    DRAWS,
    FORCE,
    HEADING,
    SHARE,
    SPEED,
    TURN,
    Pair,
    along,
    coefficient_function,
    force_on_bound,
    force_under_slip,
    limit_row,
    mu,
    times,
)
from nonsmooth.testing.component import variants
from nonsmooth.testing.functions import CheckedFunction, all_rows
from nonsmooth.testing.inputs import number
from nonsmooth.testing.outcome import Row
from nonsmooth.testing.puck import Puck, run
from nonsmooth.testing.reference import ReferenceContact, ReferenceImpact, require
from nonsmooth.types import Array

_INSTANT = 1e-7
"""Duration of the run whose change of momentum gives the friction force, relative to the time in which friction stops
the puck: so short that the slip hardly changes."""
_SLIGHT = 1e-4
"""Approach speed of a slight impact, relative to the slip speed: so small that the slip hardly changes."""
_N_OTHERS = 24
"""Number of other forces on the friction bound. The law must refuse each that dissipates less than its own force."""
_ELSEWHERE = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
"""Rotation matrix of the body that does not carry the axis of the friction law. It is oblique, because the orientation
of this body must not change the force."""
_AXIS_HEADING = number("axis_heading", -3.1, 3.1)
_LEAN = number("axis_lean", -0.5, 0.5)
_ANISOTROPIC = Claims()


def anisotropic_rows(law: AnisotropicFrictionLaw, vanishing: tuple[str, ...]) -> list[Row]:
    """Return the checks of an anisotropic friction law, one row for each required property.

    One of them checks that the friction force is zero if the parameters named in ``vanishing`` are zero.
    """
    first = rows([_ratios, _axis_and_body], lambda: variants(law), 1)
    found = [*rows([*COEFFICIENT, *_ANISOTROPIC], lambda: variants(law), DRAWS), limit_row(law, vanishing, _vanishes)]
    return all_rows(law, lambda: [_coefficient(one) for one in variants(law)], found, first)


def _coefficient(law: AnisotropicFrictionLaw) -> CheckedFunction:
    require(_ratios.fault(law, {}) or _axis_and_body.fault(law, {}))
    return coefficient_function(law)


@claim()
def _ratios(law: AnisotropicFrictionLaw) -> str:
    """The three ratios of the friction bound (forward, backward, across) are positive, and the largest is 1."""
    ratios = law.ratios
    sound = len(ratios) == 3 and all(0.0 < r <= 1.0 for r in ratios) and max(ratios) == 1.0
    return "" if sound else f"they are {tuple(ratios)}"


@claim()
def _axis_and_body(law: AnisotropicFrictionLaw) -> str:
    """The axis of the friction bound is a vector that is not zero, fixed to the first or to the second body."""
    if law.body not in ("first", "second"):
        return f"the body is {law.body!r}"
    axis = law.axis
    sound = len(axis) == 3 and all(math.isfinite(x) for x in axis) and math.hypot(*axis) > 0.0
    return "" if sound else f"the axis is {tuple(axis)}"


@_ANISOTROPIC.claim(SPEED, HEADING)
def _maximum_dissipation(law: AnisotropicFrictionLaw, speed: float, heading: float) -> str:
    """Under slip, the law accepts no force on its bound that dissipates less than the force of largest dissipation."""
    slip = along(speed, heading)
    own = force_under_slip(law, slip)
    most = -own[0] * slip[0] - own[1] * slip[1]
    forward, backward, across = law.ratios
    coefficient = mu(law, math.hypot((forward if slip[0] > 0.0 else backward) * slip[0], across * slip[1]))
    if most <= 1e-9 * speed:
        return ""
    for i in range(_N_OTHERS):
        force = force_on_bound(law, coefficient, heading + math.pi + 2.0 * math.pi * i / _N_OTHERS)
        power = -force[0] * slip[0] - force[1] * slip[1]
        if power < most * (1.0 - 1e-6) and law.is_fulfilled(slip, 1.0, force, 1e-9):
            given = f"({force[0]:g}, {force[1]:g})"
            return f"is_fulfilled accepts {given}, that takes {power:g} W, where {most:g} W is most"
    return ""


def _turns(law: AnisotropicFrictionLaw, heading: float, lean: float) -> dict[str, tuple[float, ...]]:
    """Return the orientations of puck and slab as unit quaternions, by the name of the parameter.

    The body that carries the law's axis is turned so that the axis has the angle ``heading`` in the tangent plane and
    leans out of this plane by the angle ``lean`` [rad]. The other body has an oblique orientation.
    """
    first = np.asarray(law.axis, dtype=float) / np.linalg.norm(law.axis)
    goal = np.array([*along(math.cos(lean), heading), math.sin(lean)])
    own = _basis(goal) @ _basis(first).T
    puck, slab = (_ELSEWHERE, own) if law.body == "first" else (own, _ELSEWHERE)
    return {"turn": _quaternion(puck), "slab_turn": _quaternion(slab)}


def _basis(first: Array) -> Array:
    """Return an orthonormal basis as columns, shape [3, 3]. The first column is the given unit vector."""
    second = np.cross(first, np.eye(3)[int(np.argmin(np.abs(first)))])
    second /= np.linalg.norm(second)
    return np.column_stack([first, second, np.cross(first, second)])


def _quaternion(axes: Array) -> tuple[float, ...]:
    x, y, z, s = Rotation.from_matrix(axes).as_quat().tolist()
    return s, x, y, z


def _rotated(vector: Pair, angle: float) -> Pair:
    c, s = math.cos(angle), math.sin(angle)
    return c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]


def _after(
    law: AnisotropicFrictionLaw,
    slip: Pair,
    heading: float,
    lean: float = 0.0,
    *,
    push: Pair = (0.0, 0.0),
    weight: float = 0.0,
    approach: float = 0.0,
    t_end: float,
) -> tuple[Pair, float]:
    """Return the slip velocity of a puck of 1 kg on a slab at ``t_end`` [m/s], and the energy lost to friction [J].

    Slip velocities and ``push``, a constant force on the puck [N], have a component along the axis of the friction
    bound and a component across it. The axis has the angle ``heading`` in the tangent plane, and leans out of the plane
    by ``lean`` [rad]. ``weight`` is the weight of the puck [N]. If ``approach`` [m/s] is positive, the puck strikes the
    slab at the start.
    """
    speed = max(math.hypot(*slip), 1e-3)
    puck = Puck(push=(*_rotated(push, heading), 0.0), speed=_SLIGHT * speed)
    u, laws = (*_rotated(slip, heading), -approach, 0.0, 0.0, 0.0), (ReferenceContact(), law, ReferenceImpact())
    solution = run(puck, 0.0, u, ContactLaws(*laws), t_end, gravity=weight, **_turns(law, heading, lean))
    after = _rotated((float(solution.u_end[0]), float(solution.u_end[1])), -heading)
    return after, solution.energy.friction_loss


@_ANISOTROPIC.claim(SPEED, HEADING, FORCE, SHARE, _AXIS_HEADING, _LEAN, fewest=FEWEST)
def _sustained_contact(
    law: AnisotropicFrictionLaw, speed: float, heading: float, load: float, share: float, axis: float, lean: float
) -> str:
    """The law accepts the friction forces that the engine finds for contacts that stick or slide."""
    held = times(share * load, force_on_bound(law, mu(law, 0.0), heading + math.pi))
    after, _ = _after(law, (0.0, 0.0), axis, lean, push=times(-1.0, held), weight=load, t_end=1.0)
    if math.hypot(*after) > 1e-9:
        return f"it slips at rest under ({-held[0]:g}, {-held[1]:g}) N along the axis and across, below the bound"
    if not law.is_fulfilled((0.0, 0.0), load, held, 1e-9 * load):
        return f"is_fulfilled refuses the force ({held[0]:g}, {held[1]:g}) N at rest"
    # the load is proportional to the slip speed. So the duration below, in which friction changes the slip by a small
    # part, does not depend on this speed, and is never too short for the engine's time resolution
    slip, load = along(speed, heading), load * speed
    duration = _INSTANT * speed / (load * (mu(law, speed) + 1.0))
    after, _ = _after(law, slip, axis, lean, weight=load, t_end=duration)
    t1, t2 = ((b - a) / duration for a, b in zip(slip, after, strict=True))
    if not law.is_fulfilled(slip, load, (t1, t2), 1e-5 * load):
        return f"is_fulfilled refuses the force ({t1:g}, {t2:g}) N at slip ({slip[0]:g}, {slip[1]:g}) m/s"
    return ""


@_ANISOTROPIC.claim(SPEED, HEADING, _AXIS_HEADING, fewest=FEWEST)
def _dissipation(law: AnisotropicFrictionLaw, speed: float, heading: float, axis: float) -> str:
    """Friction adds no energy in an impact."""
    _, lost = _after(law, along(speed, heading), axis, approach=speed, t_end=1e-9)
    return f"friction gives {-lost:g} J to the impact" if lost < -1e-8 * speed**2 else ""


@_ANISOTROPIC.claim(SPEED, HEADING, _AXIS_HEADING, fewest=FEWEST)
def _force_and_impact_level(law: AnisotropicFrictionLaw, speed: float, heading: float, axis: float) -> str:
    """In a slight impact, which hardly changes the slip, the ratio of friction to normal impulse is that of sliding."""
    # friction changes the slip by about the coefficient times the approach speed: a large coefficient needs a lower
    # approach speed
    slip, approach = along(speed, heading), _SLIGHT / max(1.0, mu(law, speed)) * speed
    after, _ = _after(law, slip, axis, approach=approach, t_end=1e-12)
    # normal impulse on the puck of 1 kg: the approach speed plus the rebound speed. The reference impact law returns
    # half of the energy, so the coefficient of restitution is the square root of 0.5
    pushed = approach * (1.0 + math.sqrt(0.5))
    t1, t2 = ((b - a) / pushed for a, b in zip(slip, after, strict=True))
    force = force_under_slip(law, slip)
    if math.dist((t1, t2), force) > 1e-3 * (mu(law, speed) + 1e-3):
        return f"impulses have the ratio ({t1:g}, {t2:g}), forces ({force[0]:g}, {force[1]:g})"
    return ""


@_ANISOTROPIC.claim(SPEED, HEADING, TURN, fewest=FEWEST)
def _frame_invariance(law: AnisotropicFrictionLaw, speed: float, heading: float, turn: float) -> str:
    """If both bodies and the slip are turned together, the slip after an impact is turned by the same angle."""
    slip = along(speed, heading)
    a, b = (_after(law, slip, axis, approach=speed, t_end=1e-9)[0] for axis in (0.0, turn))
    if math.dist(a, b) > 1e-6 * speed:
        return f"the slip after is ({a[0]:g}, {a[1]:g}) m/s, turned by {turn:g} rad ({b[0]:g}, {b[1]:g}) m/s"
    return ""


@claim(SPEED, HEADING)
def _vanishes(law: AnisotropicFrictionLaw, speed: float, heading: float) -> str:
    """If the coefficients are zero, friction does not change the slip in an impact."""
    slip = along(speed, heading)
    after, _ = _after(law, slip, 0.0, approach=1.0, t_end=1e-9)
    left = math.dist(slip, after)
    return f"{left:g} of the normal impulse is left" if left > 1e-9 * (1.0 + speed) else ""
