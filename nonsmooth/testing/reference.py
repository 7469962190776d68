"""Laws and matrices that the checks put beside what they look at."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces import FrictionLaw, ImpactProcess, RigidNormalLaw
from nonsmooth.parameters import parameter
from nonsmooth.rotations import cross
from nonsmooth.testing.draws import Case, Variable

Array = NDArray[np.float64]


def _force(indentation: float) -> float:
    return indentation


def _efficiency(rate: float, share: float) -> float:
    return 1.0 if rate <= 0.0 else share


@final
@dataclass(frozen=True)
class Spring(ImpactProcess):
    """A linear spring that gives back a share of what it stores."""

    share: float = parameter(0.5, doc="share", minimum=0.0, maximum=1.0)

    @property
    def force(self) -> Callable[..., float]:
        """The indentation."""
        return _force

    @property
    def efficiency(self) -> Callable[..., float]:
        """The share in expansion."""
        return _efficiency

    @property
    def contact_time(self) -> float:
        """A common one [s]."""
        return 2e-5

    def is_fulfilled(self, stored: float, returned: float, tolerance: float) -> bool:
        """Tell whether the share came back."""
        return abs(returned - self.share * stored) <= tolerance


def _constant(speed: float, level: float) -> float:
    return level


@final
@dataclass(frozen=True)
class Constant(FrictionLaw):
    """The same coefficient at every speed."""

    level: float = parameter(0.3, doc="coefficient", minimum=0.0)

    @property
    def coefficient(self) -> Callable[..., float]:
        """The level."""
        return _constant

    def is_fulfilled(
        self, slip: tuple[float, float], normal_force: float, tangential_force: tuple[float, float], tolerance: float
    ) -> bool:
        """Tell whether the force lies in the disc."""
        return math.hypot(*tangential_force) <= self.level * normal_force + tolerance


@final
@dataclass(frozen=True)
class Rigid(RigidNormalLaw):
    """A contact without any indentation."""

    def is_fulfilled(self, acceleration: float, force: float, tolerance: float) -> bool:
        """Tell whether the pair is complementary."""
        return acceleration >= -tolerance and force >= -tolerance and min(abs(acceleration), abs(force)) <= tolerance


@final
@dataclass(frozen=True)
class Problem:
    """A rigid body with contacts: M, W, N and the velocity before."""

    mass: Array
    normal: Array
    tangential: Array
    velocity: Array

    @property
    def n(self) -> int:
        """Number of contacts."""
        return int(self.normal.shape[1])

    @property
    def columns(self) -> Array:
        """Normal and tangents of each contact in turn, shape [6, 3 n]."""
        joined = np.concatenate([self.normal[:, :, None], self.tangential], axis=2)
        return np.asarray(joined.reshape(len(self.mass), 3 * self.n))

    def energy(self, velocity: Array) -> float:
        """Return the kinetic energy [J]."""
        return 0.5 * float(velocity @ self.mass @ velocity)

    @property
    def approaches(self) -> bool:
        """Whether any contact approaches."""
        return bool(np.any(self.normal.T @ self.velocity < 0.0))


def problem_space(contacts: int) -> list[Variable]:
    """Return the numbers that make a problem of one body and some contacts; the simplest falls straight down."""
    space = [
        Variable("velocity_x", -2.0, 2.0),
        Variable("velocity_y", -2.0, 2.0),
        Variable("velocity_z", -2.0, -0.1, -1.0),
        Variable("spin_x", -1.0, 1.0),
        Variable("spin_y", -1.0, 1.0),
        Variable("spin_z", -1.0, 1.0),
    ]
    for i in range(1, contacts + 1):
        space += [Variable(f"arm_{c}_{i}", -0.3, 0.3) for c in "xyz"]
        space += [Variable(f"lean_{c}_{i}", -0.4, 0.4) for c in "xy"]
    return space


def problem(case: Case, contacts: int) -> Problem:
    """Return the problem of an input."""
    normal, tangential = np.zeros((6, contacts)), np.zeros((6, contacts, 2))
    for i in range(contacts):
        place = np.array([0.0 if contacts == 1 else i - 0.5 * (contacts - 1), 0.1 * i, -0.5])
        arm = place + np.array([case[f"arm_{c}_{i + 1}"] for c in "xyz"])
        n = np.array([case[f"lean_x_{i + 1}"], case[f"lean_y_{i + 1}"], 1.0])
        n /= np.linalg.norm(n)
        first = np.array([1.0, 0.0, 0.0]) - n[0] * n
        first /= np.linalg.norm(first)
        axes = n, first, cross(n, first)
        columns = np.array([[*axis, *cross(arm, axis)] for axis in axes]).T
        normal[:, i], tangential[:, i] = columns[:, 0], columns[:, 1:]
    velocity = np.array([case[f"velocity_{c}"] for c in "xyz"] + [case[f"spin_{c}"] for c in "xyz"])
    return Problem(np.diag([1.0, 1.0, 1.0, 0.3, 0.4, 0.5]), normal, tangential, velocity)


def point(velocity: tuple[float, float, float]) -> Problem:
    """Return a point of unit mass above a plane."""
    return Problem(np.eye(3), np.eye(3)[:, 2:], np.eye(3)[:, None, :2], np.array(velocity))
