"""Systems for the checks of engines, with their expected results: a tumbling box, a driven plate, a heap of balls."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces import Body
from nonsmooth.plugins import registry
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System
from nonsmooth.testing.reference import ReferenceContact, ReferenceFriction, ReferenceImpact

GRAVITY = 9.81
"""Gravity [m/s^2]."""
FREQUENCY, AMPLITUDE = 5.0, 5e-3
"""Frequency [Hz] and amplitude [m] of the driven plate."""
RADIUS, BALLS = 0.01, 10
"""Radius [m] and number of the balls of the heap."""
_SHARE = 0.5
"""Part of the energy that an impact on the plate gives back."""
_GAP = 1e-4
"""Gap between the balls of the heap at the start [m]."""


def _made(group: str, name: str, *given: Any, **parameters: Any) -> Any:
    """Return a component by its installed name: the core knows no concrete body."""
    return registry.load(group, name)(*given, **parameters)


def _touch(system: System, first: Body, second: Body, share: float) -> None:
    laws = ReferenceContact(), ReferenceFriction(0.5), ReferenceImpact(share)
    system.contact(first, second, normal=laws[0], friction=laws[1], impact=laws[2])


def tumbling() -> System:
    """Return a box that tumbles without gravity, and a ball at rest.

    The ball is the first body. So the box's coordinates do not begin at index 0 of the system's coordinates, and a
    wrong offset in an engine shows.
    """
    ball, box = _made("bodies", "ball", RADIUS, mass=1.0), _made("bodies", "box", 0.1, 0.2, 0.3, mass=1.0)
    system = System([ball, box])
    system.exclude(ball, box)
    system.place(ball, position=(1.0, 0.0, 0.0))
    system.place(box, angular_velocity=(3.0, 0.2, -1.0))
    return system


def momentum(solution: Solution) -> NDArray[np.float64]:
    """Return the angular momentum of the tumbling box at the samples in world axes [kg m^2/s], shape [n, 3]."""
    box: Any = solution.system.bodies[1]
    # the angular velocity is in body axes
    own = solution.of(box)[1][:, 3:] * box.inertia
    return np.asarray(np.einsum("nij,nj->ni", solution.history("rotation", of=box)["rotation"][:, 0], own))


def thrown() -> System:
    """Return a ball that falls on a plate that swings vertically. They meet after one period, while the plate rises."""
    motion = _made("motions", "harmonic", AMPLITUDE, FREQUENCY)
    plate, ball = _made("bodies", "plate", motion), _made("bodies", "ball", RADIUS, mass=1.0)
    system = System([plate, ball], GRAVITY)
    _touch(system, plate, ball, _SHARE)
    system.place(ball, position=(0.0, 0.0, RADIUS + 0.5 * GRAVITY / FREQUENCY**2))
    return system


def thrown_height(time: float) -> float:
    """Return the height of the thrown ball's lowest point over the plate's mean level [m], in closed form.

    ``time`` counts from the start of the run [s]. The plate throws the ball at the time 1 / FREQUENCY. The formula
    holds from then until the ball's next impact.
    """
    restitution, speed = math.sqrt(_SHARE), 2.0 * math.pi * FREQUENCY * AMPLITUDE
    after = (1.0 + restitution) * speed + restitution * GRAVITY / FREQUENCY
    since = time - 1.0 / FREQUENCY
    return after * since - 0.5 * GRAVITY * since**2


def heap() -> System:
    """Return ten balls in three layers, 6 + 3 + 1, with small gaps over a plate. Impacts give back no energy."""
    plate = _made("bodies", "plate")
    balls = [_made("bodies", "ball", RADIUS, mass=1.0) for _ in range(BALLS)]
    system = System([plate, *balls], GRAVITY)
    for i, ball in enumerate(balls):
        for other in (plate, *balls[:i]):
            _touch(system, other, ball, 0.0)
    width = 2.0 * RADIUS + _GAP
    places = [
        (row, column, layer) for layer in range(3) for row in range(3 - layer) for column in range(3 - layer - row)
    ]
    for ball, (row, column, layer) in zip(balls, places, strict=True):
        x = width * (column + 0.5 * row + 0.5 * layer)
        y = width * math.sqrt(3.0) * (0.5 * row + layer / 6.0)
        system.place(ball, position=(x, y, RADIUS + _GAP + width * math.sqrt(2.0 / 3.0) * layer))
    return system


def overlap(solution: Solution) -> float:
    """Return the deepest overlap of balls of the heap with each other or the plate at the samples [m]."""
    centres = np.stack([solution.of(body)[0][:, :3] for body in solution.system.bodies[1:]], axis=1)
    i, j = np.triu_indices(BALLS, 1)
    apart = np.linalg.norm(centres[:, i] - centres[:, j], axis=2) - 2.0 * RADIUS
    return -min(float(apart.min()), float(centres[:, :, 2].min()) - RADIUS)


def energies(solution: Solution) -> NDArray[np.float64]:
    """Return kinetic and potential energy at the samples [J], shape [n]."""
    kinetic, potential = solution.history("kinetic_energy", "potential_energy").values()
    return np.asarray(kinetic + potential)
