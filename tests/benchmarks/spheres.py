"""The balls of the box scenario in MuJoCo and in PyBullet, from the same start.

Both are given radius, mass, friction, places and velocities.  PyBullet gets the coefficient of restitution as Newton's,
MuJoCo a time constant of ten steps and the damping that belongs to it.
"""

from __future__ import annotations

import importlib
import math

import numpy as np

from bodies import Ball
from nonsmooth.solution.solution import Solution
from scenarios.ball_box import BallBox
from tests.benchmarks.engines import GRAVITY, Floats

_THICK = 0.05
"""Half thickness of floor and walls [m]."""


def start(scenario: BallBox) -> tuple[Floats, Floats]:
    """Return places [m] and velocities [m/s] of the balls at the start, shapes [n, 3]."""
    system = scenario.build()
    states = [system.start(body) for body in system.bodies if isinstance(body, Ball)]
    return np.array([q[:3] for q, _ in states]), np.array([u[:3] for _, u in states])


def depth(scenario: BallBox, places: Floats) -> float:
    """Return the deepest overlap of balls with each other and with the box [m]; 0 if there is none."""
    r = scenario.radius
    one, two = np.triu_indices(len(places), 1)
    between = np.min(np.linalg.norm(places[one] - places[two], axis=1)) - 2.0 * r
    walls = 0.5 * scenario.box_width - r - np.max(np.abs(places[:, :2]))
    return max(0.0, -float(min(between, walls, np.min(places[:, 2]) - r)))


def own_depth(scenario: BallBox, solution: Solution) -> float:
    """Return the deepest overlap over the samples of our run [m]."""
    return max(depth(scenario, places) for places in scenario.positions(solution))


def _slabs(scenario: BallBox) -> list[tuple[tuple[float, float, float], tuple[float, float, float]]]:
    """Return half sizes and centres of floor and walls [m]."""
    half, high = 0.5 * scenario.box_width, 1.0
    wide = half + 2.0 * _THICK
    slabs = [((wide, wide, _THICK), (0.0, 0.0, -_THICK))]
    for sign in (-1.0, 1.0):
        slabs.append(((_THICK, wide, high), (sign * (half + _THICK), 0.0, high)))
        slabs.append(((wide, _THICK, high), (0.0, sign * (half + _THICK), high)))
    return slabs


class MuJoCoBox:
    """Free spheres in a box of five slabs."""

    def __init__(self, scenario: BallBox, step: float) -> None:
        self._mujoco = importlib.import_module("mujoco")
        self._scenario, self._step = scenario, step
        places, self._velocities = start(scenario)
        decrement = -math.log(scenario.restitution)
        damping = decrement / math.hypot(math.pi, decrement)
        contact = f'friction="{scenario.friction} 0 0" solref="{10.0 * step} {damping}" condim="3"'
        slabs = "".join(
            f'<geom type="box" size="{a} {b} {c}" pos="{x} {y} {z}" {contact}/>'
            for (a, b, c), (x, y, z) in _slabs(scenario)
        )
        balls = "".join(
            f'<body pos="{x} {y} {z}"><freejoint/>'
            f'<geom type="sphere" size="{scenario.radius}" mass="{scenario.mass}" {contact}/></body>'
            for x, y, z in places
        )
        self._model = self._mujoco.MjModel.from_xml_string(
            f'<mujoco><size memory="64M"/><option timestep="{step}" gravity="0 0 -{GRAVITY}"/>'
            f"<worldbody>{slabs}{balls}</worldbody></mujoco>"
        )
        self._data = self._mujoco.MjData(self._model)

    def reset(self) -> None:
        """Go back to the start."""
        self._mujoco.mj_resetData(self._model, self._data)
        self._data.qvel.reshape(-1, 6)[:, :3] = self._velocities

    def run(self, t_end: float) -> None:
        """Simulate, in one call."""
        self._mujoco.mj_step(self._model, self._data, round(t_end / self._step))

    def deepest(self, t_end: float) -> float:
        """Simulate, look at every step, and return the deepest overlap [m]; not for timing."""
        self.reset()
        worst = 0.0
        for _ in range(round(t_end / self._step)):
            self._mujoco.mj_step(self._model, self._data, 1)
            worst = max(worst, depth(self._scenario, np.array(self._data.qpos).reshape(-1, 7)[:, :3]))
        return worst


class PyBulletBox:
    """Free spheres in a box of five slabs."""

    def __init__(self, scenario: BallBox, step: float) -> None:
        bullet = importlib.import_module("pybullet")
        self._client = importlib.import_module("pybullet_utils.bullet_client").BulletClient(bullet.DIRECT)
        self._scenario, self._step = scenario, step
        self._places, self._velocities = start(scenario)
        client = self._client
        client.setGravity(0.0, 0.0, -GRAVITY)
        client.setPhysicsEngineParameter(fixedTimeStep=step, restitutionVelocityThreshold=0.0)
        # products over the pair count: roots on either side
        surface = {
            "lateralFriction": math.sqrt(scenario.friction),
            "restitution": math.sqrt(scenario.restitution),
            "linearDamping": 0.0,
            "angularDamping": 0.0,
        }
        for half, centre in _slabs(scenario):
            shape = client.createCollisionShape(bullet.GEOM_BOX, halfExtents=half)
            client.changeDynamics(client.createMultiBody(0.0, shape, -1, centre), -1, **surface)
        sphere = client.createCollisionShape(bullet.GEOM_SPHERE, radius=scenario.radius)
        self._balls = [client.createMultiBody(scenario.mass, sphere, -1, place.tolist()) for place in self._places]
        for ball in self._balls:
            client.changeDynamics(ball, -1, **surface)

    def reset(self) -> None:
        """Go back to the start."""
        for ball, place, velocity in zip(self._balls, self._places, self._velocities, strict=True):
            self._client.resetBasePositionAndOrientation(ball, place.tolist(), (0.0, 0.0, 0.0, 1.0))
            self._client.resetBaseVelocity(ball, velocity.tolist(), (0.0, 0.0, 0.0))

    def run(self, t_end: float) -> None:
        """Simulate."""
        for _ in range(round(t_end / self._step)):
            self._client.stepSimulation()

    def deepest(self, t_end: float) -> float:
        """Simulate, look at every step, and return the deepest overlap [m]; not for timing."""
        self.reset()
        worst = 0.0
        for _ in range(round(t_end / self._step)):
            self._client.stepSimulation()
            places = [self._client.getBasePositionAndOrientation(ball)[0] for ball in self._balls]
            worst = max(worst, depth(self._scenario, np.array(places)))
        return worst
