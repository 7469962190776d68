"""Properties of friction whose bound is made of two half ellipses, fixed to a body."""

from __future__ import annotations

import math

import numpy as np

from nonsmooth.interfaces import AnisotropicFrictionLaw, ImpactLaw
from nonsmooth.testing.coefficient import (
    FORCE,
    HEADING,
    SHARE,
    SPEED,
    along,
    coefficient_function,
    coefficient_rows,
    limit_row,
    mu,
)
from nonsmooth.testing.component import component_rows, variants
from nonsmooth.testing.draws import Case, Variable
from nonsmooth.testing.examine import FEWEST, Trial, examine
from nonsmooth.testing.functions import Function, Functions
from nonsmooth.testing.property import NotChecked, Property, Row, properties
from nonsmooth.testing.puck import Array, Puck, run
from nonsmooth.testing.reference import Rigid, Spring

_DRAWS = 10
_INSTANT = 1e-7
"""Part of the time to stop over which a force is taken as the change of momentum."""
_SLIGHT = 1e-4
"""Approach in units of the slip speed that leaves the slip as it is."""
_OTHERS = 24
_ELSEWHERE = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])
"""Axes of the body that does not have the law's axis."""
_AXIS_HEADING = Variable("axis_heading", -3.1, 3.1)
_LEAN = Variable("axis_lean", -0.5, 0.5)
Pair = tuple[float, float]


def anisotropic_properties(law: AnisotropicFrictionLaw, vanishing: tuple[str, ...]) -> list[Property]:
    """Return the properties of an anisotropic friction law, of which ``vanishing`` are the coefficients."""
    functions = Functions(lambda: [_coefficient(one) for one in variants(law)])

    def row(name: str, says: str, trial: Trial, *space: Variable) -> Row:
        return name, says, lambda: examine(name, variants(law), space, trial, _DRAWS, fewest=FEWEST)

    first = [
        row("ratios", "they are three, positive, and the largest is 1", _ratios),
        row("axis and body", "the axis is a vector that is not zero, of the first or the second body", _axis),
    ]
    rows = [
        *coefficient_rows(law),
        row(
            "certificate under slip",
            "the force of the law obeys it, one along the slip or off the bound does not",
            _certificate_slip,
            SPEED,
            HEADING,
            FORCE,
        ),
        row(
            "certificate at rest",
            "a force within the bound obeys it, one outside does not",
            _certificate_rest,
            HEADING,
            FORCE,
            SHARE,
        ),
        row(
            "maximum dissipation",
            "of all forces in the bound it accepts one under slip, that takes out most energy",
            _dissipates_most,
            SPEED,
            HEADING,
        ),
        row(
            "sustained contact",
            "forces that the engine finds for contacts that stick or slide obey it",
            _sustained,
            SPEED,
            HEADING,
            FORCE,
            SHARE,
            _AXIS_HEADING,
            _LEAN,
        ),
        row("dissipation", "friction takes energy out of impacts", _dissipates, SPEED, HEADING, _AXIS_HEADING),
        row(
            "force and impact level",
            "an impact too slight to change the slip has the direction and ratio of impulses that the force has",
            _levels,
            SPEED,
            HEADING,
            _AXIS_HEADING,
        ),
        row(
            "frame invariance",
            "where the bodies and the slip are turned together, an impact turns with them",
            _turned,
            SPEED,
            HEADING,
            Variable("turn", -3.1, 3.1, 1.0),
        ),
        limit_row(law, vanishing, _vanishes),
    ]
    return properties(law, [*component_rows(law), *first, *functions.rows(), *functions.guarded(rows)])


def _coefficient(law: AnisotropicFrictionLaw) -> Function:
    if found := _ratios(law, {}) or _axis(law, {}):
        raise NotChecked(f"not checked, as {found}")
    return coefficient_function(law)


def _ratios(law: AnisotropicFrictionLaw, case: Case) -> str:
    ratios = law.ratios
    sound = len(ratios) == 3 and all(0.0 < r <= 1.0 for r in ratios) and max(ratios) == 1.0
    return "" if sound else f"they are {tuple(ratios)}"


def _axis(law: AnisotropicFrictionLaw, case: Case) -> str:
    if law.body not in ("first", "second"):
        return f"the body is {law.body!r}"
    axis = law.axis
    sound = len(axis) == 3 and all(math.isfinite(x) for x in axis) and math.hypot(*axis) > 0.0
    return "" if sound else f"the axis is {tuple(axis)}"


def _under_slip(law: AnisotropicFrictionLaw, slip: Pair) -> Pair:
    """Return the force along the axis and across it for a normal force of 1 N."""
    forward, backward, across = law.ratios
    first = forward if slip[0] > 0.0 else backward
    counted = first * slip[0], across * slip[1]
    size = math.hypot(*counted)
    factor = -mu(law, size) / size
    return factor * first * counted[0], factor * across * counted[1]


def _on_bound(law: AnisotropicFrictionLaw, coefficient: float, heading: float) -> Pair:
    """Return the largest force in a direction for a normal force of 1 N."""
    forward, backward, across = law.ratios
    c, s = along(1.0, heading)
    # forces backward oppose slip forward
    size = coefficient / math.hypot(c / (forward if c < 0.0 else backward), s / across)
    return size * c, size * s


def _times(share: float, force: Pair) -> Pair:
    return share * force[0], share * force[1]


def _certificate_slip(law: AnisotropicFrictionLaw, case: Case) -> str:
    slip, load = along(case["slip_speed"], case["heading"]), case["normal_force"]
    force = _times(load, _under_slip(law, slip))
    bound = math.hypot(*force)
    tried = [(1.0, True)] + [(share, False) for share in (-1.0, 0.5, 1.5, 0.0)] * (bound > 1e-6 * load)
    for share, expected in tried:
        if bool(law.is_fulfilled(slip, load, _times(share, force), 1e-9 * load)) is not expected:
            word = "refuses" if expected else "accepts"
            return f"is_fulfilled {word} {share:g} of the force ({force[0]:g}, {force[1]:g}) N of the law"
    return ""


def _certificate_rest(law: AnisotropicFrictionLaw, case: Case) -> str:
    load = case["normal_force"]
    bound = _times(load, _on_bound(law, mu(law, 0.0), case["heading"]))
    size = math.hypot(*bound)
    outside = 1.01 + (1e-3 * load / size if size > 0.0 else 0.0)
    for share, expected in ((case["share"], True), (outside, False)):
        force = _times(share, bound) if size > 0.0 or expected else along(1e-3 * load, case["heading"])
        if bool(law.is_fulfilled((0.0, 0.0), load, force, 1e-9 * load)) is not expected:
            word = "refuses" if expected else "accepts"
            return f"is_fulfilled {word} {share:g} of the bound ({bound[0]:g}, {bound[1]:g}) N at rest"
    return ""


def _dissipates_most(law: AnisotropicFrictionLaw, case: Case) -> str:
    slip = along(case["slip_speed"], case["heading"])
    own = _under_slip(law, slip)
    most = -own[0] * slip[0] - own[1] * slip[1]
    # the coefficient that the law has at this slip
    forward, backward, across = law.ratios
    coefficient = mu(law, math.hypot((forward if slip[0] > 0.0 else backward) * slip[0], across * slip[1]))
    if most <= 1e-9 * case["slip_speed"]:
        return ""
    for i in range(_OTHERS):
        force = _on_bound(law, coefficient, case["heading"] + math.pi + 2.0 * math.pi * i / _OTHERS)
        power = -force[0] * slip[0] - force[1] * slip[1]
        if power < most * (1.0 - 1e-6) and law.is_fulfilled(slip, 1.0, force, 1e-9):
            return (
                f"is_fulfilled accepts ({force[0]:g}, {force[1]:g}), that takes {power:g} W, where {most:g} W is most"
            )
    return ""


def _in_place(law: AnisotropicFrictionLaw, heading: float, lean: float) -> tuple[Array, Array]:
    """Return the axes of puck and slab, so that the law's axis has a heading in their contact and leans out of it."""
    first = np.asarray(law.axis, dtype=float) / np.linalg.norm(law.axis)
    goal = np.array([*along(math.cos(lean), heading), math.sin(lean)])
    own = _basis(goal) @ _basis(first).T
    return (_ELSEWHERE, own) if law.body == "first" else (own, _ELSEWHERE)


def _basis(first: Array) -> Array:
    """Return axes as columns, the first as given."""
    second = np.cross(first, np.eye(3)[int(np.argmin(np.abs(first)))])
    second /= np.linalg.norm(second)
    return np.column_stack([first, second, np.cross(first, second)])


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
    """Return the slip after a time, along the axis and across it as all vectors here, and the energy lost to friction.

    The puck has 1 kg; with an approach it strikes at once.
    """
    puck_axes, slab = _in_place(law, heading, lean)
    speed = max(math.hypot(*slip), 1e-3)
    puck = Puck(
        push=(*_rotated(push, heading), 0.0), axes=tuple(puck_axes.ravel().tolist()), length=1.0, speed=_SLIGHT * speed
    )
    u = (*_rotated(slip, heading), -approach, 0.0, 0.0, 0.0)
    impact: ImpactLaw = Spring()
    solution = run(puck, 0.0, u, (Rigid(), law, impact), t_end, gravity=weight, slab=tuple(slab.ravel().tolist()))
    after = _rotated((float(solution.u_end[0]), float(solution.u_end[1])), -heading)
    return after, solution.energy.friction_loss


def _sustained(law: AnisotropicFrictionLaw, case: Case) -> str:
    load, heading, lean = case["normal_force"], case["axis_heading"], case["axis_lean"]
    push = _times(case["share"] * load, _on_bound(law, mu(law, 0.0), case["heading"] + math.pi))
    after, _ = _after(law, (0.0, 0.0), heading, lean, push=_times(-1.0, push), weight=load, t_end=1.0)
    if math.hypot(*after) > 1e-9:
        return f"it slips at rest under ({-push[0]:g}, {-push[1]:g}) N along the axis and across, below the bound"
    if not law.is_fulfilled((0.0, 0.0), load, push, 1e-9 * load):
        return f"is_fulfilled refuses the force ({push[0]:g}, {push[1]:g}) N at rest"
    slip = along(case["slip_speed"], case["heading"])
    duration = _INSTANT * case["slip_speed"] / (load * (mu(law, case["slip_speed"]) + 1.0))
    after, _ = _after(law, slip, heading, lean, weight=load, t_end=duration)
    t1, t2 = ((b - a) / duration for a, b in zip(slip, after, strict=True))
    if not law.is_fulfilled(slip, load, (t1, t2), 1e-5 * load):
        return f"is_fulfilled refuses the force ({t1:g}, {t2:g}) N at slip ({slip[0]:g}, {slip[1]:g}) m/s"
    return ""


def _dissipates(law: AnisotropicFrictionLaw, case: Case) -> str:
    slip = along(case["slip_speed"], case["heading"])
    _, lost = _after(law, slip, case["axis_heading"], approach=case["slip_speed"], t_end=1e-9)
    return f"friction gives {-lost:g} J to the impact" if lost < -1e-8 * case["slip_speed"] ** 2 else ""


def _levels(law: AnisotropicFrictionLaw, case: Case) -> str:
    speed = case["slip_speed"]
    slip = along(speed, case["heading"])
    approach = _SLIGHT * speed
    after, _ = _after(law, slip, case["axis_heading"], approach=approach, t_end=1e-12)
    # the spring of the reference gives back half of the energy
    pushed = approach * (1.0 + math.sqrt(0.5))
    t1, t2 = ((b - a) / pushed for a, b in zip(slip, after, strict=True))
    force = _under_slip(law, slip)
    if math.dist((t1, t2), force) > 1e-3 * (mu(law, speed) + 1e-3):
        return f"impulses have the ratio ({t1:g}, {t2:g}), forces ({force[0]:g}, {force[1]:g})"
    return ""


def _turned(law: AnisotropicFrictionLaw, case: Case) -> str:
    speed, turn = case["slip_speed"], case["turn"]
    slip = along(speed, case["heading"])
    a, b = (_after(law, slip, heading, approach=speed, t_end=1e-9)[0] for heading in (0.0, turn))
    if math.dist(a, b) > 1e-6 * speed:
        return f"the slip after is ({a[0]:g}, {a[1]:g}) m/s, turned by {turn:g} rad ({b[0]:g}, {b[1]:g}) m/s"
    return ""


def _vanishes(law: AnisotropicFrictionLaw, case: Case) -> str:
    slip = along(case["slip_speed"], case["heading"])
    after, _ = _after(law, slip, 0.0, approach=1.0, t_end=1e-9)
    left = math.dist(slip, after)
    return f"{left:g} of the normal impulse is left" if left > 1e-9 * (1.0 + case["slip_speed"]) else ""
