"""Directions in which a state can be moved, of which unit quaternions stay unit."""

from __future__ import annotations

import dataclasses
from collections.abc import Collection, Iterator
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import UnknownName
from nonsmooth.solution.state import State
from nonsmooth.system.system import System

Floats = NDArray[np.float64]
TURNS = ("rx", "ry", "rz")
"""Turns of a body with a quaternion about its own axes, which stand for the quaternion's four numbers."""


@final
@dataclass(frozen=True)
class Chart:
    """Directions about a state, in units of the scales of the bodies.

    Attributes
    ----------
    basis : array
        A direction a column, shape [n_q + n_u, m].
    names : tuple of str
        What each moves: a coordinate or a velocity, or the turn of a body.
    quaternions : tuple of int
        Where the quaternions begin.
    """

    basis: Floats
    names: tuple[str, ...]
    quaternions: tuple[int, ...]

    @classmethod
    def at(cls, system: System, state: State, within: Collection[str] | None = None) -> Chart:
        """Return the directions about a state.

        Parameters
        ----------
        system : System
            The system.
        state : State
            The state.
        within : collection of str, optional
            Names of the coordinates and velocities that may change ("z", or "ball.z" where only that of one body is
            meant), and of turns about a body's own axes ("rx", "ry", "rz"); all by default.

        Raises
        ------
        UnknownName
            If a coordinate has no such name.
        """
        labels, chosen = list(_labels(system)), _chosen(system, within)
        scale = np.concatenate([*(b.scales[0] for b in system.bodies), *(b.scales[1] for b in system.bodies)])
        y, (turning, starts) = np.concatenate([state.q, state.u]), _quaternions(system)
        columns, names = list[Floats](), list[str]()
        for i, (body, label) in enumerate(labels):
            if not any(start <= i < start + 4 for start in starts) and label in chosen[body]:
                columns.append(scale[i] * np.eye(len(y))[i])
                names.append(f"{body}.{label}")
        for body, start in zip(turning, starts, strict=True):
            for turn, column in zip(TURNS, _turns(y[start : start + 4]), strict=True):
                if turn in chosen[body]:
                    columns.append(np.zeros(len(y)))
                    columns[-1][start : start + 4] = column
                    names.append(f"{body}.{turn}")
        return cls(np.array(columns).reshape(-1, len(y)).T, tuple(names), starts)

    def moved(self, state: State, way: Floats) -> State:
        """Return a state moved along the directions, shape [m]."""
        x = np.concatenate([state.q, state.u]) + self.basis @ way
        for start in self.quaternions:
            x[start : start + 4] /= np.linalg.norm(x[start : start + 4])
        return dataclasses.replace(state, q=x[: len(state.q)], u=x[len(state.q) :])

    def between(self, one: State, two: State) -> Floats:
        """Return how far along the directions the second state is from the first, shape [m]."""
        x = np.concatenate([two.q - one.q, two.u - one.u])
        return np.asarray(np.linalg.lstsq(self.basis, x, rcond=None)[0])


def _labels(system: System) -> Iterator[tuple[str, str]]:
    """Give body and name of each coordinate, then of each velocity."""
    for kind in ("q_labels", "u_labels"):
        for name, body in zip(system.names.bodies, system.bodies, strict=True):
            yield from ((name, label) for label, _ in getattr(body, kind))


def _quaternions(system: System) -> tuple[tuple[str, ...], tuple[int, ...]]:
    """Return the bodies that have a quaternion, and where these begin."""
    firsts = np.cumsum([0, *(body.n_q for body in system.bodies)]).tolist()
    found = [
        (name, first + body.quaternion)
        for name, body, first in zip(system.names.bodies, system.bodies, firsts, strict=False)
        if body.quaternion >= 0
    ]
    return tuple(name for name, _ in found), tuple(start for _, start in found)


def _turns(q: Floats) -> Floats:
    """Return how a unit quaternion changes with turns about the three axes of its body, shape [3, 4]."""
    w, x, y, z = q
    return 0.5 * np.array([[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]])


def _chosen(system: System, within: Collection[str] | None) -> dict[str, set[str]]:
    """Return the names that may change, by body."""
    known = {
        name: {label for label, _ in (*body.q_labels, *body.u_labels)} | (set(TURNS) if body.quaternion >= 0 else set())
        for name, body in zip(system.names.bodies, system.bodies, strict=True)
    }
    if within is None:
        return known
    whole = {f"{body}.{label}" for body, labels in known.items() for label in labels}
    for name in within:
        if name not in whole and not any(name in labels for labels in known.values()):
            raise UnknownName("coordinate", name, whole)
    return {
        body: {label for label in labels if label in within or f"{body}.{label}" in within}
        for body, labels in known.items()
    }


def coordinate_number(system: System, name: str) -> int:
    """Return where a coordinate or velocity stands behind one another with all coordinates and velocities.

    Raises
    ------
    UnknownName
        If there is none of that name.
    """
    labels = list(_labels(system))
    for i, (body, label) in enumerate(labels):
        if name in (label, f"{body}.{label}"):
            return i
    raise UnknownName("coordinate", name, {f"{body}.{label}" for body, label in labels})
