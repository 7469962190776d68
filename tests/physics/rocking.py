"""A box that tips from one lower edge onto the other one: closed form of the time, and runs."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import trimesh
from scipy.integrate import solve_ivp

import nonsmooth as ns
from bodies import Box, BoxBody, DrivenBody, HullBody, MeshBody, Rest, Triangles
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.interfaces import Body
from tests.benchmarks.head_on.measured import TOUCHES, gap
from tests.benchmarks.random_systems.pieces import pieces_of, rotations

HALVES = (0.05, 0.03, 0.02)
"""Halves of the box [m]."""
TILT = 0.1
"""Angle at which it starts, at rest on its left edge [rad]."""
GRAVITY = 9.81
_FRICTION = 2.0
"""Coefficient of friction, with which the edge does not slip."""


def _hull() -> Body:
    return HullBody(list(itertools.product(*((-half, half) for half in HALVES))))


def _mesh() -> Body:
    made = trimesh.creation.box(np.multiply(2.0, HALVES))
    return MeshBody(Triangles(made.vertices, made.faces))


BODIES: dict[str, Callable[[], Body]] = {"box": lambda: BoxBody(*HALVES), "hull": _hull, "mesh": _mesh}
"""What makes the body that tips."""


@dataclass(frozen=True)
class Supports:
    """What is below: boxes at rest with their upper faces at height 0, by their sides along x and y [m]."""

    boxes: tuple[tuple[tuple[float, float], tuple[float, float]], ...]

    def bodies(self) -> list[Body]:
        """Return the boxes, 40 mm high."""
        made: list[Body] = []
        for (left, right), (front, back) in self.boxes:
            middle = 0.5 * (left + right), 0.5 * (front + back), -0.02
            made.append(DrivenBody(Rest(position=middle), (Box(0.5 * (right - left), 0.5 * (back - front), 0.02),)))
        return made


_X, _Y, _ = HALVES
SUPPORTS = {
    "wide": Supports((((-0.1, 0.1), (-0.1, 0.1)),)),
    "as deep": Supports((((-0.1, 0.1), (-_Y, _Y)),)),
    "equal": Supports((((-_X, _X), (-_Y, _Y)),)),
    "flush on the left": Supports((((-_X, 0.1), (-0.1, 0.1)),)),
    "two": Supports((((-0.1, 0.0), (-0.1, 0.1)), ((0.01, 0.1), (-0.1, 0.1)))),
    "two as deep": Supports((((-0.1, 0.0), (-_Y, _Y)), ((0.01, 0.1), (-_Y, _Y)))),
    "two that end with it": Supports((((-_X, -0.03), (-_Y, _Y)), ((0.03, _X), (-_Y, _Y)))),
    "two flush at a seam": Supports((((-0.1, 0.0), (-_Y, _Y)), ((0.0, 0.1), (-_Y, _Y)))),
}
"""What is below the box: where it lies in the end, its middle is at x = y = 0."""


def time_of_landing(start: float = TILT) -> float:
    """Return the time after which the right edge is as low as the left one [s]: a pendulum about the left edge."""
    x, _, z = HALVES
    arm, angle = math.hypot(x, z), math.atan2(z, x)

    def rate(_: float, y: np.ndarray) -> list[float]:
        return [y[1], -0.75 * GRAVITY / arm * math.cos(angle + y[0])]

    def lands(_: float, y: np.ndarray) -> float:
        return float(y[0])

    lands.terminal = True  # type: ignore[attr-defined]
    found = solve_ivp(rate, (0.0, 1.0), [start, 0.0], "DOP853", events=lands, rtol=1e-13, atol=1e-15)
    return float(found.t_events[0][0])


@dataclass(frozen=True)
class Rocked:
    """A run.

    Attributes
    ----------
    landed : float
        Time of the first impact [s].
    height : float
        Height of the body over its place on the supports, at the end [m].
    speed : float
        Largest velocity at the end [m/s, rad/s].
    depth : float
        Deepest overlap of body and supports over the samples and events, measured by support functions [m].
    status : str
        How it ended.
    """

    landed: float
    height: float
    speed: float
    depth: float
    status: str


def rocked(body: str, below: str, restitution: float = 0.0, drop: float = 0.0) -> Rocked:
    """Start the body at rest with its left edge at a height over the supports [m], tilted, and run for 0.4 s."""
    made, supports = BODIES[body](), SUPPORTS[below].bodies()
    system = ns.System([*supports, made], GRAVITY)
    laws = ns.ContactLaws(Unilateral(), Coulomb(_FRICTION), EnergeticImpact(restitution))
    for support in supports:
        system.contact(support, made, normal=laws.normal, friction=laws.friction, impact=laws.impact)
    x, _, z = HALVES
    c, s = math.cos(TILT), math.sin(TILT)
    # about the left lower edge at (-x, 0, 0)
    place = (-x + c * x - s * z, 0.0, s * x + c * z + drop)
    system.place(made, position=place, orientation=ns.turned_about((0.0, 1.0, 0.0), -TILT))
    solution = ns.simulate(system, 0.4, sample_interval=2e-3)
    events = solution.events
    landed = float(events.time[events.cause == ns.Cause.IMPACT][0])
    q, u = solution.of(made)
    deepest = max(_depths(made, supports, np.concatenate([q, events.q])))
    return Rocked(landed, float(q[-1, 2]) - z, float(np.abs(u[-1]).max()), deepest, str(solution.status))


def _depths(body: Body, supports: list[Body], q: np.ndarray) -> list[float]:
    mine, axes = pieces_of(body), rotations(q[:, 3:])
    still = np.eye(3)
    return [
        -gap(pieces_of(support), mine, (np.array(support.motion.position), still), (row[:3], turned), TOUCHES)  # type: ignore[attr-defined]
        for support in supports
        for row, turned in zip(q, axes, strict=True)
    ]
