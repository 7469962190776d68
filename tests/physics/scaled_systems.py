"""Systems that can be built at any size: lengths, times and masses are multiples of units."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

import nonsmooth as ns
from bodies import Ball, BoxBody, CapsuleBody, CylinderBody, Dumbbell, Harmonic, HullBody, OpenBox, Plate
from laws import Coulomb, EnergeticImpact, LinearCompliant, Unilateral
from tests.physics.moved_systems import quaternion

Array = NDArray[np.float64]
SIZE = 2.0**-6
"""Size of the bodies [units of length]."""
GRAVITY = 9.8125
"""Gravity [units of length / units of time^2]: that of the Earth in metres and seconds."""
_POSE = {"orientation": quaternion((1.0, 2.0, 3.0), 0.7)}
_SPIN = np.array([3.0, -5.0, 2.0])


@dataclass(frozen=True)
class Units:
    """Units of length [m], time [s] and mass [kg]."""

    length: float
    time: float
    mass: float

    @property
    def speed(self) -> float:
        """Unit of velocity [m/s]."""
        return self.length / self.time

    def rigid(self, restitution: float, friction: float) -> dict[str, Any]:
        """Laws of a rigid contact. The deformation of its impacts is linear, so that it takes no powers."""
        impact = EnergeticImpact(restitution, exponent=1.0, duration=2.0**-16 * self.time)
        return {"normal": Unilateral(), "friction": Coulomb(friction), "impact": impact}

    def system(self, bodies: list[Any], gravity: float = GRAVITY) -> ns.System:
        """System with a gravity in these units."""
        return ns.System(bodies, gravity * self.length / self.time**2)

    def place(self, system: ns.System, body: Any, at: Any, velocity: Any = (0, 0, 0), spin: Any = (0, 0, 0)) -> None:
        """Place a body at a position, turned if it spins."""
        system.place(
            body,
            position=np.array(at) * self.length,
            velocity=np.array(velocity) * self.speed,
            angular_velocity=np.array(spin) / self.time,
            **(_POSE if np.any(spin) else {}),
        )


Made = tuple[ns.System, float]


def _thrown(units: Units, body: Any) -> Made:
    """A body thrown on a plate, and the end [units of time]."""
    plate = Plate()
    system = units.system([plate, body])
    system.contact(body, plate, **units.rigid(0.5, 0.3))
    units.place(system, body, (0.0, 0.0, 3.0 * SIZE), (0.25, 0.125, -0.25), _SPIN)
    return system, 0.125


def _meeting(units: Units, one: Any, two: Any, spin: Any = _SPIN) -> Made:
    """Two bodies that collide in space without gravity."""
    system = units.system([one, two], 0.0)
    system.contact(one, two, **units.rigid(0.75, 0.3))
    units.place(system, one, (-5.0 * SIZE, 0.25 * SIZE, 0.0), (0.5, 0.0, 0.0), spin)
    units.place(system, two, (0.0, 0.0, 0.0), (-0.25, 0.0, 0.0))
    return system, 0.25


def _box(units: Units, x: float = 1.0, y: float = 0.75, z: float = 0.5) -> BoxBody:
    unit = SIZE * units.length
    return BoxBody(x * unit, y * unit, z * unit, mass=0.25 * units.mass)


def box_on_plate(units: Units) -> Made:
    """A box thrown on a plate."""
    return _thrown(units, _box(units))


def capsule_on_plate(units: Units) -> Made:
    """A capsule thrown on a plate."""
    return _thrown(units, CapsuleBody(0.5 * SIZE * units.length, SIZE * units.length, mass=0.25 * units.mass))


def cylinder_on_plate(units: Units) -> Made:
    """A cylinder thrown on a plate."""
    return _thrown(units, CylinderBody(SIZE * units.length, 0.75 * SIZE * units.length, mass=0.25 * units.mass))


def two_balls(units: Units) -> Made:
    """Two balls that collide."""
    balls = (Ball(part * SIZE * units.length, mass=0.25 * units.mass) for part in (1.0, 2.0))
    return _meeting(units, *balls)


def two_boxes(units: Units) -> Made:
    """Two boxes of which one tumbles."""
    return _meeting(units, _box(units), _box(units, 1.0, 1.75, 1.5))


def flush_boxes(units: Units) -> Made:
    """Two cubes that collide with parallel faces."""
    return _meeting(units, _box(units, 1.0, 1.0, 1.0), _box(units, 1.0, 1.0, 1.0), (0.0, 0.0, 0.0))


def two_hulls(units: Units) -> Made:
    """Two hulls of 14 points on a sphere."""
    points = np.random.default_rng(3).normal(size=(14, 3))
    points = np.round(1024.0 * points / np.linalg.norm(points, axis=1)[:, None]) / 1024.0
    hulls = (HullBody((part * SIZE * units.length * points).tolist(), mass=0.25 * units.mass) for part in (1.0, 1.5))
    return _meeting(units, *hulls)


def ball_on_spring(units: Units) -> Made:
    """A ball thrown on a plate by a compliant contact."""
    ball, plate = Ball(SIZE * units.length, mass=0.25 * units.mass), Plate()
    system = units.system([plate, ball])
    normal = LinearCompliant(2.0**14 * units.mass / units.time**2, 2.0 * units.mass / units.time)
    system.contact(ball, plate, normal=normal, friction=Coulomb(0.3))
    units.place(system, ball, (0.0, 0.0, 2.0 * SIZE), (0.25, 0.0, 0.0), _SPIN)
    return system, 0.5


def driven_dumbbell(units: Units) -> Made:
    """A dumbbell on a vibrating plate."""
    radius = 0.00476
    body = Dumbbell(radius=radius * units.length, density=7800.0 * units.mass / units.length**3)
    plate = Plate(Harmonic(amplitude=3.58e-4 * units.length, frequency=25.0 / units.time))
    system = units.system([plate, body])
    system.contact(body, plate, **units.rigid(0.65, 0.2))
    system.place(
        body,
        position=np.array([0.0, 0.0, 2.5 * radius]) * units.length,
        orientation=quaternion((0.0, 1.0, 0.0), 0.3),
        velocity=np.array([0.01, 0.0, 0.0]) * units.speed,
    )
    return system, 0.5


def box_on_box(units: Units) -> Made:
    """A box that slides on a box, which rests on a plate."""
    upper, lower, plate = _box(units), _box(units, 2.0, 2.0, 0.5), Plate()
    system = units.system([plate, lower, upper])
    system.contact(lower, plate, **units.rigid(0.5, 0.3))
    system.contact(upper, lower, **units.rigid(0.5, 0.3))
    units.place(system, lower, (0.0, 0.0, 0.5 * SIZE))
    units.place(system, upper, (0.0, 0.0, 1.5 * SIZE), (0.25, 0.125, 0.0))
    return system, 0.25


def tower(units: Units) -> Made:
    """Three boxes on one another, each a little aside. The uppermost one slides."""
    _, *boxes = bodies = [Plate(), *(_box(units) for _ in range(3))]
    system = units.system(bodies)
    for lower, upper in itertools.pairwise(bodies):
        system.contact(lower, upper, **units.rigid(0.5, 0.3))
    for i, box in enumerate(boxes):
        speed = 0.25 if box is boxes[-1] else 0.0
        units.place(system, box, (i * SIZE / 16.0, 0.0, (i + 0.5) * SIZE), (speed, 0.0, 0.0))
    return system, 0.25


def balls_in_box(units: Units) -> Made:
    """Four balls that fall into an open box, bounce and come to rest."""
    balls = [Ball((1.0 + i / 8.0) * SIZE * units.length, mass=0.25 * units.mass) for i in range(4)]
    box = OpenBox(4.0 * SIZE * units.length, 4.0 * SIZE * units.length)
    system = units.system([box, *balls])
    for one, two in itertools.combinations((box, *balls), 2):
        system.contact(one, two, **units.rigid(0.5, 0.3))
    for i, ball in enumerate(balls):
        at = 3.0 * SIZE * (i % 2 - 0.5), 3.125 * SIZE * (i // 2 - 0.5), (3.0 + i) * SIZE
        units.place(system, ball, at, (0.25 * (-1.0) ** i, 0.125, 0.0))
    return system, 0.375


SYSTEMS: Mapping[str, Callable[[Units], Made]] = {
    make.__name__: make
    for make in (
        box_on_plate,
        capsule_on_plate,
        cylinder_on_plate,
        two_balls,
        two_boxes,
        flush_boxes,
        two_hulls,
        ball_on_spring,
        driven_dumbbell,
        box_on_box,
        tower,
        balls_in_box,
    )
}


@dataclass(frozen=True)
class Outcome:
    """Result of a run, in units of the system.

    Attributes
    ----------
    q, u : array
        Coordinates and velocities at 32 samples.
    times : array
        Times of the events.
    causes : list of str
        Their causes.
    unexplained : float
        Largest energy that no work and no loss explains, relative to the range of kinetic and potential energy.
    """

    q: Array
    u: Array
    times: Array
    causes: list[str]
    unexplained: float


def run(name: str, units: Units, engine: ns.EventDriven | None = None) -> Outcome:
    """Run a system, by default with the default engine."""
    system, t_end = SYSTEMS[name](units)
    end = t_end * units.time
    solution = ns.simulate(system, end, sample_interval=end / 32.0, engine=engine or ns.EventDriven())
    assert solution.status == "done"
    of_q, of_u = {"m": units.length}, {"m/s": units.speed, "rad/s": 1.0 / units.time}
    q = solution.q / [of_q.get(unit, 1.0) for body in system.bodies for _, unit in body.q_labels]
    u = solution.u / [of_u[unit] for body in system.bodies for _, unit in body.u_labels]
    energies = solution.history("kinetic_energy", "potential_energy", "unexplained_energy")
    kinetic, potential, unexplained = energies.values()
    error = float(np.max(np.abs(unexplained)) / np.ptp(kinetic + potential))
    events = solution.events
    return Outcome(q, u, events.time / units.time, events.causes(), error)


def similar(length: float, *, same_gravity: bool) -> Units:
    """Units with this length: of the same gravity, or of the same times. Masses grow with the volume."""
    return Units(length, math.sqrt(length) if same_gravity else 1.0, length**3)
