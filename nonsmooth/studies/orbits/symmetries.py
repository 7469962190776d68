"""Symmetries: rotations that commute with the motion, and sections modulo such rotations."""

from __future__ import annotations

import dataclasses
import itertools
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import final

import numpy as np

from nonsmooth.checks import floats
from nonsmooth.errors import InvalidInput, RunFailed, UnknownName
from nonsmooth.interfaces.body import POSE_LABELS, TWIST_LABELS
from nonsmooth.rotations import rotation, turned
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.coordinates import quaternions_of, scales_of
from nonsmooth.studies.derivatives.flow import FlowSegment
from nonsmooth.studies.orbits.sections import Section
from nonsmooth.system.system import System
from nonsmooth.types import Array

_PROBE = 1e-5
"""Step of the central difference that gives the derivative of a state by the angle of a symmetry [rad]."""
_IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])
_AXES = "xyz"
_TEST_ANGLE = 1.0
"""Angle by which a state is turned to test a symmetry [rad]."""
_SAME = 1e-6
"""Largest difference between the motion from a turned start and the turned motion of a symmetric system.

It is relative to the scales of the coordinates, and larger than the errors of runs.
"""
_GUESSES, _MOST = 5, 20
"""Number of initial guesses per full turn, and largest number of Newton steps from the best of these guesses.

The unknowns are the angles by which the symmetries turn an end state back, nearest to the start.
"""
_CLOSE = 1e-9
"""Step at which Newton's method ends [rad]: an error along a symmetry does not change the orbit."""


class Symmetry(ABC):
    """A one-parameter group of rotations that maps motions to motions."""

    @abstractmethod
    def turned(self, system: System, state: State, angle: float) -> State:
        """Return a state turned by an angle [rad].

        Raises
        ------
        InvalidInput
            If a moving body is not free in space.
        """

    def direction(self, system: System, state: State) -> Array:
        """Return the derivative of a state by the angle, shape [n_q + n_u]."""
        one, two = (self.turned(system, state, angle) for angle in (-_PROBE, _PROBE))
        return np.concatenate([two.q - one.q, two.u - one.u]) / (2.0 * _PROBE)


@final
@dataclass(frozen=True)
class Turn(Symmetry):
    """All bodies turn together about an axis through the origin, by default the vertical.

    Attributes
    ----------
    axis : tuple of float
        Direction of the axis, shape [3].

    Raises
    ------
    InvalidInput
        If the axis has not three components, or is zero.
    """

    axis: tuple[float, float, float] = (0.0, 0.0, 1.0)

    def __post_init__(self) -> None:
        given = floats("Turn.axis", self.axis)
        if given.shape != (3,) or not np.linalg.norm(given) > 0.0:
            raise InvalidInput("Turn.axis", "must be a direction", self.axis, "For example (0, 0, 1).")

    def __str__(self) -> str:
        """Return the name of the symmetry."""
        return f"turn about ({', '.join(f'{x:g}' for x in self.axis)})"

    def turned(self, system: System, state: State, angle: float) -> State:
        """Return the state with all bodies turned about the axis by an angle [rad]."""
        q, u = state.q.copy(), state.u.copy()
        way = angle * np.asarray(self.axis) / np.linalg.norm(self.axis)
        matrix = rotation(turned(_IDENTITY, way))
        for _, i, j in _free(system):
            q[i : i + 3], u[j : j + 3] = matrix @ q[i : i + 3], matrix @ u[j : j + 3]
            q[i + 3 : i + 7] = turned(q[i + 3 : i + 7], way)
        return dataclasses.replace(state, q=q, u=u)


@final
@dataclass(frozen=True)
class Spin(Symmetry):
    """A body turns about an axis about which its shape and its inertia are symmetric.

    Attributes
    ----------
    body : str
        Name of the body.
    axis : str
        Axis of symmetry in the frame of the body: "x", "y" or "z".
    """

    body: str
    axis: str

    def __post_init__(self) -> None:
        if self.axis not in tuple(_AXES):
            raise UnknownName("Spin.axis", self.axis, _AXES)

    def __str__(self) -> str:
        """Return the name of the symmetry."""
        return f"spin of {self.body} about its {self.axis}"

    def turned(self, system: System, state: State, angle: float) -> State:
        """Return the state with the body turned by an angle [rad]; its angular velocity in world axes is the same."""
        places = {name: (i, j) for name, i, j in _free(system)}
        if self.body not in places:
            raise UnknownName("Spin.body", self.body, places)
        i, j = places[self.body]
        own = np.eye(3)[_AXES.index(self.axis)]
        q, u = state.q.copy(), state.u.copy()
        q[i + 3 : i + 7] = turned(q[i + 3 : i + 7], angle * rotation(q[i + 3 : i + 7]) @ own)
        u[j + 3 : j + 6] = rotation(turned(_IDENTITY, -angle * own)) @ u[j + 3 : j + 6]
        return dataclasses.replace(state, q=q, u=u)


def _free(system: System) -> Iterator[tuple[str, int, int]]:
    """Yield name, and offsets in q and u, of all moving bodies; raise InvalidInput if one is not free in space."""
    i = j = 0
    for name, body in zip(system.names.bodies, system.bodies, strict=True):
        if body.n_u:
            if (body.q_labels, body.u_labels) != (POSE_LABELS, TWIST_LABELS):
                remedy = "Leave the symmetry out, or what repeats by `within`."
                raise InvalidInput(f"symmetry: the body {name!r}", "must be free in space", body.q_labels, remedy)
            yield name, i, j
        i, j = i + body.n_q, j + body.n_u


@final
@dataclass(frozen=True)
class RelativeSection(Section):
    """Section of an orbit that repeats up to rotations: after each period, symmetries turn the state back.

    The state is turned back to be as near to the start as possible.

    Attributes
    ----------
    section : Section
        Section at which a period ends.
    symmetries : tuple of Symmetry
        Symmetries by which a period may turn the motion.
    """

    section: Section
    symmetries: tuple[Symmetry, ...]

    def flow(self, model: Model, start: State) -> FlowSegment:
        """Run for one period, then turn the end state by the symmetries such that it is nearest to the start.

        Raises
        ------
        InvalidInput
            If a contact is closed at the end: its slip direction would have to be turned back, too.
        """
        segment = self.section.flow(model, start)
        if np.any(segment.state.modes):
            remedy = "Choose another time in the period, or leave the symmetries out."
            raise InvalidInput("section: symmetries", "need a section with all contacts open", "closed", remedy)
        return replace(segment, state=self._back(model, segment.state, self._angles(model, start, segment.state)))

    def with_period(self, period: float) -> RelativeSection:
        """Return the section with another period [s]."""
        return replace(self, section=self.section.with_period(period))

    def fixed(self, model: Model) -> tuple[str, ...]:
        """Return the coordinates that are constant on the section."""
        return self.section.fixed(model)

    def ignored(self, model: Model, state: State) -> Array:
        """Return the directions along which the symmetries turn a state, shape [n_q + n_u, k].

        States that differ only along these directions are taken as equal.
        """
        return np.column_stack([one.direction(model.system, state) for one in self.symmetries])

    def check(self, model: Model, start: State) -> None:
        """Check each symmetry: a run from a turned start must end in the turned end state of the run from the start.

        Both runs last one period.

        Raises
        ------
        InvalidInput
            If the system lacks a symmetry.
        """
        end = self.section.flow(model, start).state
        for one in self.symmetries:
            expected, begin = (one.turned(model.system, state, _TEST_ANGLE) for state in (end, start))
            try:
                there = self.section.flow(model, begin).state
                difference = np.concatenate([there.q - expected.q, there.u - expected.u]) / scales_of(model.system)
                off = float(np.max(np.abs(difference)))
                found = f"a period ends {off:.2g} elsewhere, in units of scales" if off > _SAME else ""
            except (InvalidInput, RunFailed) as error:
                found = f"there is no period ({error})"
            if found:
                rule = f"must be one of the system, but turned by {_TEST_ANGLE:g} rad {found}"
                raise InvalidInput("orbit: symmetries", rule, str(one), "Leave it out.")

    def turns(self, model: Model, start: State) -> dict[str, float]:
        """Return, by the name of each symmetry, the angle by which a state has turned after one period [rad].

        Angles are between -pi and pi.
        """
        angles = self._angles(model, start, self.section.flow(model, start).state)
        return dict(zip(map(str, self.symmetries), angles.tolist(), strict=True))

    def _back(self, model: Model, state: State, angles: Array) -> State:
        for one, angle in zip(self.symmetries, angles.tolist(), strict=True):
            state = one.turned(model.system, state, -angle)
        return state

    def _angles(self, model: Model, start: State, end: State) -> Array:
        """Return the angles by which the end state is turned back to be nearest to the start [rad], by Newton."""
        scales = np.concatenate([body.scales[1] for body in model.system.bodies])
        rows = [slice(at, at + 4) for at in quaternions_of(model.system).values()]

        def seen(state: State) -> Array:
            # an orientation has two quaternions, q and -q: take the one nearer to the start
            turns = [state.q[at] * (1.0 if state.q[at] @ start.q[at] >= 0.0 else -1.0) for at in rows]
            return np.concatenate([*turns, state.u / scales])

        def left(angles: Array) -> Array:
            return seen(self._back(model, end, angles)) - seen(start)

        tried = np.linspace(-np.pi, np.pi, _GUESSES, endpoint=False)
        guesses = [np.array(angles) for angles in itertools.product(tried, repeat=len(self.symmetries))]
        angles = min(guesses, key=lambda one: float(np.linalg.norm(left(one))))
        for _ in range(_MOST):
            steps = 1e-6 * np.eye(len(self.symmetries))
            slopes = np.column_stack([(left(angles + h) - left(angles - h)) / 2e-6 for h in steps])
            change = np.linalg.lstsq(slopes, -left(angles), rcond=1e-8)[0]
            angles = angles + change
            if np.max(np.abs(change)) <= _CLOSE:
                break
        return np.asarray((angles + np.pi) % (2.0 * np.pi) - np.pi)
