"""Systems that many tests start from."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from hypothesis import settings
from numpy.typing import NDArray

import nonsmooth as ns
from bodies import Dumbbell, Plate, Rest
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.kernel import room_addresses

settings.register_profile("tests", deadline=None, derandomize=True, print_blob=False)
settings.load_profile("tests")

GRAVITY = 9.81


class Builders:
    """Functions that put bodies on plates; all lengths in [m], angles in [rad]."""

    def laws(
        self, restitution: float = 0.5, friction: float = 0.2, static: float | None = None, **impact: Any
    ) -> dict[str, Any]:
        """Return the three laws of a contact; friction 0 is Frictionless."""
        return {
            "normal": Unilateral(),
            "friction": Frictionless() if friction == 0.0 else Coulomb(friction, static),
            "impact": EnergeticImpact(restitution, **impact),
        }

    def over(self, body: Any, motion: Any = None, gravity: float = GRAVITY, **laws: Any) -> ns.System:
        """Return a system of a plate and a body in contact with it."""
        plate = Plate(motion if motion is not None else Rest())
        system = ns.System([plate, body], gravity)
        system.contact(plate, body, **self.laws(**laws))
        return system

    def lived(self, solution: ns.Solution) -> list[str]:
        """Return the mode words that took time, the longest first."""
        return [word for word, share in solution.modes.items() if share > 0.0]

    def axes(self, theta: float, beta: float, gamma: float) -> NDArray[np.float64]:
        """Return the rotation matrix of Eq. (2), body axes as columns."""
        from scipy.spatial.transform import Rotation

        return np.asarray(Rotation.from_euler("ZYX", [math.pi / 2 + theta, -beta, gamma]).as_matrix())

    def quaternion(self, theta: float, beta: float, gamma: float) -> NDArray[np.float64]:
        """Return the unit quaternion of Eq. (2), scalar first."""
        from scipy.spatial.transform import Rotation

        x, y, z, s = Rotation.from_euler("ZYX", [math.pi / 2 + theta, -beta, gamma]).as_quat()
        return np.array([s, x, y, z])

    def paper_start(self, dumbbell: Dumbbell, q: Any, rate: Any) -> Mapping[str, Any]:
        """Return the start of a dumbbell at (x1, y1, z1, theta, beta, gamma) and its rate."""
        x1, v1 = np.asarray(q[:3], dtype=float), np.asarray(rate[:3], dtype=float)
        theta, beta, gamma = q[3:]
        axes = self.axes(theta, beta, gamma)
        second = np.array([-math.cos(theta), -math.sin(theta), 0.0])
        omega = rate[3] * np.array([0.0, 0.0, 1.0]) - rate[4] * second + rate[5] * axes[:, 0]
        arm = 0.5 * dumbbell.centre_distance * axes[:, 0]
        return {
            "position": x1 + arm,
            "orientation": self.quaternion(theta, beta, gamma),
            "velocity": v1 + np.cross(omega, arm),
            "angular_velocity": axes.T @ omega,
        }


@pytest.fixture(scope="session", autouse=True)
def engine() -> None:
    """Compile the engine before the first test, so that none has to see the message."""
    room_addresses()


@pytest.fixture(scope="session")
def build() -> Builders:
    """Return the builders."""
    return Builders()
