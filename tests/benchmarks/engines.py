"""The same dumbbell on the same vibrating plate in MuJoCo and in PyBullet, as fast as their users can run it.

Both are given mass, inertia, friction and start of the scenario.  Neither has an energetic restitution: PyBullet
gets the scenario's coefficient as Newton's, MuJoCo a damping of its soft contacts.
"""

from __future__ import annotations

import importlib
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bodies import Dumbbell
from scenarios.dumbbell import DumbbellScenario

Floats = NDArray[np.float64]
GRAVITY = 9.81
_PLATE_MASS = 1e6
"""In masses of the dumbbell: what the plate's own swing must not notice."""


@dataclass(frozen=True)
class Motion:
    """What the dumbbell did at equal intervals.

    Attributes
    ----------
    t : array
        Times [s], shape [n].
    centre : array
        Mass centre [m], shape [n, 3].
    gap : array
        Smallest gap of the two balls [m], shape [n].

    """

    t: Floats
    centre: Floats
    gap: Floats


class MuJoCo:
    """A free body of two spheres over a box on a spring that swings as the plate does.

    The plate is a heavy mass on a slide joint, whose spring has the plate's frequency, started with the plate's
    velocity: it vibrates inside ``mj_step``, with the right velocity in the contacts, and no Python runs between steps.
    """

    def __init__(self, scenario: DumbbellScenario, step: float, time_constant: float, damping_ratio: float) -> None:
        self._mujoco = importlib.import_module("mujoco")
        self._step, self._radius = step, scenario.radius
        body = _body(scenario)
        mass, (along, across, _) = body.total_mass, body.inertia
        half, tilt = body.centre_distance / 2.0, float(scenario.resolved()["beta0"])
        place = f"0 {half * math.cos(tilt)} {self._radius + half * math.sin(tilt)}"
        omega = 2.0 * math.pi * scenario.frequency
        self._start_rate = scenario.amplitude * omega
        contact = f'friction="{scenario.friction} 0 0" solref="{time_constant} {damping_ratio}" condim="3"'
        plate_mass = _PLATE_MASS * mass
        text = f"""<mujoco>
          <option timestep="{step}" gravity="0 0 -{GRAVITY}"/>
          <worldbody>
            <body gravcomp="1">
              <joint type="slide" axis="0 0 1" stiffness="{plate_mass * omega**2}"/>
              <geom type="box" size="1 1 0.05" pos="0 0 -0.05" mass="{plate_mass}" {contact}/>
            </body>
            <body pos="{place}" euler="{math.degrees(tilt)} 0 0">
              <freejoint/>
              <inertial pos="0 0 0" mass="{mass}" diaginertia="{across} {along} {across}"/>
              <geom type="sphere" size="{self._radius}" pos="0 {-half} 0" {contact}/>
              <geom type="sphere" size="{self._radius}" pos="0 {half} 0" {contact}/>
            </body>
          </worldbody>
        </mujoco>"""
        self._model = self._mujoco.MjModel.from_xml_string(text)
        self._data = self._mujoco.MjData(self._model)

    def reset(self) -> None:
        """Go back to the start."""
        self._mujoco.mj_resetData(self._model, self._data)
        self._data.qvel[0] = self._start_rate

    def run(self, t_end: float) -> None:
        """Simulate, in one call."""
        self._mujoco.mj_step(self._model, self._data, round(t_end / self._step))

    def watch(self, t_end: float) -> Motion:
        """Simulate and look at every step; not for timing."""
        self.reset()
        t, centre, gap = [], [], []
        for _ in range(round(t_end / self._step)):
            self._mujoco.mj_step(self._model, self._data, 1)
            self._mujoco.mj_kinematics(self._model, self._data)
            lowest = float(min(self._data.geom_xpos[1:, 2]))
            t.append(self._data.time)
            centre.append(np.array(self._data.qpos[1:4]))
            gap.append(lowest - self._radius - float(self._data.qpos[0]))
        return Motion(np.array(t), np.array(centre), np.array(gap))


class PyBullet:
    """A body of two spheres over a box on a prismatic joint, whose motor takes it to the plate's place in every step.

    A plate that is only put in its place costs a quarter less, but its velocity does not reach the contacts.
    """

    def __init__(self, scenario: DumbbellScenario, step: float) -> None:
        self._bullet = bullet = importlib.import_module("pybullet")
        self._step, self._amplitude, self._radius = step, scenario.amplitude, scenario.radius
        self._omega = 2.0 * math.pi * scenario.frequency
        body = _body(scenario)
        half, tilt, radius = body.centre_distance / 2.0, float(scenario.resolved()["beta0"]), scenario.radius
        self._half = half
        self._start = (
            (0.0, half * math.cos(tilt), radius + half * math.sin(tilt)),
            bullet.getQuaternionFromEuler((tilt, 0.0, 0.0)),
        )
        bullet.connect(bullet.DIRECT)
        bullet.setGravity(0.0, 0.0, -GRAVITY)
        # the default threshold would take restitution away from most of these impacts
        bullet.setPhysicsEngineParameter(fixedTimeStep=step, restitutionVelocityThreshold=0.0)
        box = bullet.createCollisionShape(bullet.GEOM_BOX, halfExtents=(1.0, 1.0, 0.05))
        self._plate = bullet.createMultiBody(
            basePosition=(0.0, 0.0, -0.05),
            linkMasses=[1e3 * body.total_mass],
            linkCollisionShapeIndices=[box],
            linkVisualShapeIndices=[-1],
            linkPositions=[(0.0, 0.0, 0.0)],
            linkOrientations=[(0.0, 0.0, 0.0, 1.0)],
            linkInertialFramePositions=[(0.0, 0.0, 0.0)],
            linkInertialFrameOrientations=[(0.0, 0.0, 0.0, 1.0)],
            linkParentIndices=[0],
            linkJointTypes=[bullet.JOINT_PRISMATIC],
            linkJointAxis=[(0.0, 0.0, 1.0)],
        )
        balls = bullet.createCollisionShapeArray(
            shapeTypes=[bullet.GEOM_SPHERE] * 2,
            radii=[radius] * 2,
            collisionFramePositions=[[0.0, -half, 0.0], [0.0, half, 0.0]],
        )
        self._dumbbell = bullet.createMultiBody(body.total_mass, balls, -1, *self._start)
        # products over the pair count: roots on either side
        surface = {
            "lateralFriction": math.sqrt(scenario.friction),
            "restitution": math.sqrt(_restitution(scenario)),
            "linearDamping": 0.0,
            "angularDamping": 0.0,
        }
        along, across, _ = body.inertia
        bullet.changeDynamics(self._plate, 0, jointDamping=0.0, **surface)
        bullet.changeDynamics(self._dumbbell, -1, localInertiaDiagonal=(across, along, across), **surface)

    def reset(self) -> None:
        """Go back to the start."""
        self._bullet.resetJointState(self._plate, 0, 0.0, self._amplitude * self._omega)
        self._bullet.resetBasePositionAndOrientation(self._dumbbell, *self._start)
        self._bullet.resetBaseVelocity(self._dumbbell, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))

    def run(self, t_end: float) -> None:
        """Simulate."""
        for index in range(round(t_end / self._step)):
            self._advance((index + 1) * self._step)

    def _advance(self, t: float) -> None:
        bullet = self._bullet
        bullet.setJointMotorControl2(
            self._plate,
            0,
            bullet.POSITION_CONTROL,
            targetPosition=self._amplitude * math.sin(self._omega * t),
            positionGain=1.0,
            velocityGain=1.0,
            force=1e6,
        )
        bullet.stepSimulation()

    def watch(self, t_end: float) -> Motion:
        """Simulate and look at every step; not for timing."""
        self.reset()
        t, centre, gap = [], [], []
        for index in range(round(t_end / self._step)):
            self._advance((index + 1) * self._step)
            position, orientation = self._bullet.getBasePositionAndOrientation(self._dumbbell)
            rise = self._half * self._bullet.getMatrixFromQuaternion(orientation)[7]
            t.append((index + 1) * self._step)
            centre.append(np.array(position))
            gap.append(position[2] - abs(rise) - self._radius - self._bullet.getJointState(self._plate, 0)[0])
        return Motion(np.array(t), np.array(centre), np.array(gap))


def _body(scenario: DumbbellScenario) -> Dumbbell:
    return Dumbbell(
        scenario.radius, float(scenario.resolved()["aspect_ratio"]), scenario.density, scenario.rod_mass_fraction
    )


def damping_ratio(scenario: DumbbellScenario) -> float:
    """Return the damping ratio of a spring that gives back e times the speed after half a swing."""
    decrement = -math.log(_restitution(scenario))
    return decrement / math.hypot(math.pi, decrement)


def _restitution(scenario: DumbbellScenario) -> float:
    return float(scenario.resolved()["restitution"])
