"""Symmetries: turns after which a system goes on as before, but for the turn."""

from __future__ import annotations

import dataclasses
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.checks import floats
from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.interfaces.body import POSE_LABELS, TWIST_LABELS
from nonsmooth.rotations import rotation, turned
from nonsmooth.solution.state import State
from nonsmooth.system.system import System

Floats = NDArray[np.float64]
_PROBE = 1e-5
_SAME = np.array([1.0, 0.0, 0.0, 0.0])
_AXES = "xyz"


class Symmetry(ABC):
    """Turns by any angle, of which those by small ones add up to the others."""

    @abstractmethod
    def turned(self, system: System, state: State, angle: float) -> State:
        """Return a state turned by an angle [rad].

        Raises
        ------
        InvalidInput
            If the bodies are not such that can be turned.
        """

    def direction(self, system: System, state: State) -> Floats:
        """Return how a state changes with the angle, shape [n_q + n_u]."""
        one, two = (self.turned(system, state, angle) for angle in (-_PROBE, _PROBE))
        return np.concatenate([two.q - one.q, two.u - one.u]) / (2.0 * _PROBE)


@final
@dataclass(frozen=True)
class Turn(Symmetry):
    """All bodies together turn about an axis through the origin: about the vertical where the ground is level.

    Attributes
    ----------
    axis : tuple of float
        Its direction, shape [3].
    """

    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)

    def __post_init__(self) -> None:
        """Look at the axis.

        Raises
        ------
        InvalidInput
            If it is no direction.
        """
        given = floats("Turn.axis", self.axis)
        if given.shape != (3,) or not np.linalg.norm(given) > 0.0:
            raise InvalidInput("Turn.axis", "must be a direction", self.axis, "For example (0, 0, 1).")

    def __str__(self) -> str:
        """Return its name."""
        return f"turn about ({', '.join(f'{x:g}' for x in self.axis)})"

    def turned(self, system: System, state: State, angle: float) -> State:
        """Return all bodies turned."""
        q, u = state.q.copy(), state.u.copy()
        way = angle * np.asarray(self.axis) / np.linalg.norm(self.axis)
        matrix = rotation(turned(_SAME, way))
        for _, i, j in _free(system):
            q[i : i + 3], u[j : j + 3] = matrix @ q[i : i + 3], matrix @ u[j : j + 3]
            q[i + 3 : i + 7] = turned(q[i + 3 : i + 7], way)
        return dataclasses.replace(state, q=q, u=u)


@final
@dataclass(frozen=True)
class Spin(Symmetry):
    """A body turns about an axis of its own about which it is symmetric, in shape and inertia.

    Attributes
    ----------
    body : str
        Its name.
    axis : str
        "x", "y" or "z".
    """

    body: str
    axis: str

    def __post_init__(self) -> None:
        if self.axis not in tuple(_AXES):
            raise UnknownName("Spin.axis", self.axis, _AXES)

    def __str__(self) -> str:
        """Return its name."""
        return f"spin of {self.body} about its {self.axis}"

    def turned(self, system: System, state: State, angle: float) -> State:
        """Return the body turned, with what it moves about its other axes."""
        places = {name: (i, j) for name, i, j in _free(system)}
        if self.body not in places:
            raise UnknownName("Spin.body", self.body, places)
        i, j = places[self.body]
        own = np.eye(3)[_AXES.index(self.axis)]
        q, u = state.q.copy(), state.u.copy()
        q[i + 3 : i + 7] = turned(q[i + 3 : i + 7], angle * rotation(q[i + 3 : i + 7]) @ own)
        u[j + 3 : j + 6] = rotation(turned(_SAME, -angle * own)) @ u[j + 3 : j + 6]
        return dataclasses.replace(state, q=q, u=u)


def _free(system: System) -> Iterator[tuple[str, int, int]]:
    """Give name, and offsets in q and u, of all bodies that move: those have to be free in space."""
    i = j = 0
    for name, body in zip(system.names.bodies, system.bodies, strict=True):
        if body.n_u:
            if (body.q_labels, body.u_labels) != (POSE_LABELS, TWIST_LABELS):
                remedy = "Leave the symmetry out, or what repeats by `within`."
                raise InvalidInput(f"symmetry: the body {name!r}", "must be free in space", body.q_labels, remedy)
            yield name, i, j
        i, j = i + body.n_q, j + body.n_u
