"""Directions in which a state can be moved: unit quaternions stay unit, closed contacts closed."""

from __future__ import annotations

import dataclasses
from collections.abc import Collection
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.errors import InvalidInput
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.coordinates import TURNS, labels_of, labels_within, quaternions_of
from nonsmooth.studies.derivatives.held import Held
from nonsmooth.system.system import System

Floats = NDArray[np.float64]
_PROBE = 1e-6
"""Change that derivatives of what is held are taken with, in units of scales."""
_DEPENDS = 1e-6
"""Part of the largest derivative below which one is none,"""
_EARLIER = 0.1
"""and of the largest that is left, above which the first one is taken: so that neighbours have the same directions."""
_MOST = 20
"""Steps of Newton's method."""


@final
@dataclass(frozen=True)
class Chart:
    """Directions about a state, in units of the scales of the bodies.

    Closed contacts take directions away: along the rest a state moves freely, and those that were taken away follow,
    so that gaps stay closed, and what sticks goes on sticking.

    Attributes
    ----------
    basis : array
        A direction a column, shape [n_q + n_u, m].
    names : tuple of str
        What each moves: a coordinate or a velocity, or the turn of a body.
    quaternions : tuple of int
        Where the quaternions begin.
    held : Held
        The closed contacts.
    following : array
        The directions that follow, shape [n_q + n_u, k].
    inverse : array
        How far these go for what is left of gaps and rates, shape [k, n_held].
    ignored : array
        Directions in which states are taken for the same, shape [n_q + n_u, s].
    """

    basis: Floats
    names: tuple[str, ...]
    quaternions: tuple[int, ...]
    held: Held
    following: Floats
    inverse: Floats
    ignored: Floats

    @classmethod
    def at(
        cls,
        model: Model,
        state: State,
        within: Collection[str] | None = None,
        without: Collection[str] = (),
        ignored: Floats | None = None,
    ) -> Chart:
        """Return the directions about a state.

        Parameters
        ----------
        model : Model
            The model.
        state : State
            The state.
        within : collection of str, optional
            Names of the coordinates and velocities that may change ("z", or "ball.z" where only that of one body is
            meant), and of turns about a body's own axes ("rx", "ry", "rz"); all by default.
        without : collection of str
            Whole names of those that do not ("ball.z").
        ignored : array, optional
            Directions in which states are taken for the same, shape [n_q + n_u, s].

        Raises
        ------
        UnknownName
            If a coordinate has no such name.
        InvalidInput
            If the law of a closed contact has inner states.
        """
        system, held = model.system, Held.at(model, state)
        columns, names = _columns(system, state, within, without)
        # what may not change tells nothing of how far something went
        same = (
            np.zeros((len(columns), 0)) if ignored is None else np.where(np.any(columns, axis=1)[:, None], ignored, 0.0)
        )
        kept = _independent(columns, same)
        columns, names = columns[:, kept], tuple(names[i] for i in kept)
        if not names and len(held.closed):
            rule = (
                "must leave a coordinate or velocity free besides the one of the section, as contacts are closed there"
            )
            raise InvalidInput("section: within", rule, within, "Name more coordinates, or choose another section.")
        quaternions = quaternions_of(system)[1]
        whole = cls(columns, names, quaternions, held, columns[:, :0], np.zeros((0, 0)), same)
        rows = whole._slopes(model, state)
        follow = _following(rows)
        free = [i for i in range(len(names)) if i not in follow]
        inverse = np.asarray(np.linalg.pinv(rows[:, follow], rcond=_DEPENDS), dtype=np.float64)
        chosen = tuple(names[i] for i in free)
        return cls(columns[:, free], chosen, quaternions, held, columns[:, follow], inverse, same)

    def moved(self, model: Model, state: State, way: Floats) -> State:
        """Return a state moved along the directions, shape [m]; what is closed in it is closed in this model."""
        return self.held_in(model, self._stepped(state, self.basis @ way))

    def held_in(self, model: Model, state: State) -> State:
        """Return a state near another one, in which contacts are as closed as they can be in a model."""
        if not self.following.size:
            return state
        left = self.held.left(model, state)
        for _ in range(_MOST):
            there = self._stepped(state, -self.following @ (self.inverse @ left))
            smaller = self.held.left(model, there)
            if not np.max(np.abs(smaller)) < np.max(np.abs(left)):
                break
            state, left = there, smaller
        return state

    def between(self, one: State, two: State) -> Floats:
        """Return how far along the directions the second state is from the first, shape [m]."""
        columns = np.column_stack([self.basis, self.ignored])
        return self._along(columns, one, two)[: self.basis.shape[1]]

    def following_between(self, one: State, two: State) -> Floats:
        """Return how far along the directions that follow the second state is from the first, shape [k]."""
        columns = np.column_stack([self.following, self.basis, self.ignored])
        return self._along(columns, one, two)[: self.following.shape[1]]

    def _along(self, columns: Floats, one: State, two: State) -> Floats:
        """Return the coefficients of columns in the difference of two states, by least squares."""
        q = two.q.copy()
        for start in self.quaternions:
            # after a whole turn a body has the other one of the two quaternions of its orientation
            if q[start : start + 4] @ one.q[start : start + 4] < 0.0:
                q[start : start + 4] *= -1.0
        x = np.concatenate([q - one.q, two.u - one.u])
        return np.asarray(np.linalg.lstsq(columns, x, rcond=None)[0])

    def _stepped(self, state: State, change: Floats) -> State:
        x = np.concatenate([state.q, state.u]) + change
        for start in self.quaternions:
            x[start : start + 4] /= np.linalg.norm(x[start : start + 4])
        return dataclasses.replace(state, q=x[: len(state.q)], u=x[len(state.q) :])

    def _slopes(self, model: Model, state: State) -> Floats:
        """Return the derivatives of what is held along all directions, shape [n_held, m]."""

        def left(change: Floats) -> Floats:
            return self.held.left(model, self._stepped(state, change))

        found = [(left(_PROBE * way) - left(-_PROBE * way)) / (2.0 * _PROBE) for way in self.basis.T]
        return np.array(found).reshape(len(found), -1).T if len(self.held.closed) else np.zeros((0, len(found)))


def _following(rows: Floats) -> list[int]:
    """Return directions that follow all others, as many as there are independent rows.

    One after the other is taken, and what it does is taken off the rest.
    """
    # gaps and rates have other units
    sizes = np.linalg.norm(rows, axis=1, keepdims=True)
    left, found = rows / np.where(sizes > 0.0, sizes, 1.0), list[int]()
    largest = np.max(np.linalg.norm(left, axis=0), initial=0.0)
    while True:
        lengths = np.linalg.norm(left, axis=0)
        longest = np.max(lengths, initial=0.0)
        if longest <= _DEPENDS * largest:
            return found
        i = int(np.flatnonzero(lengths >= _EARLIER * longest)[0])
        found.append(i)
        unit = left[:, i] / lengths[i]
        left = left - np.outer(unit, unit @ left)
        left[:, i] = 0.0


def _independent(columns: Floats, same: Floats) -> list[int]:
    """Return the directions that are left of some where others are taken for none, in their order."""
    basis, kept = np.linalg.qr(same)[0], list[int]()
    while True:
        # what the others leave of each
        left = columns - basis @ (basis.T @ columns)
        shares = np.linalg.norm(left, axis=0) / np.linalg.norm(columns, axis=0)
        shares[kept] = 0.0
        i = int(np.argmax(shares)) if len(shares) else 0
        if not len(shares) or shares[i] <= _DEPENDS:
            return sorted(kept)
        kept.append(i)
        basis = np.column_stack([basis, left[:, i] / np.linalg.norm(left[:, i])])


def _columns(
    system: System, state: State, within: Collection[str] | None, without: Collection[str]
) -> tuple[Floats, tuple[str, ...]]:
    """Return all directions about a state that may change, shape [n_q + n_u, m], and their names."""
    labels, chosen = list(labels_of(system)), labels_within(system, within)
    scale = np.concatenate([*(b.scales[0] for b in system.bodies), *(b.scales[1] for b in system.bodies)])
    y, (turning, starts) = np.concatenate([state.q, state.u]), quaternions_of(system)
    columns, names = list[Floats](), list[str]()
    for i, (body, label) in enumerate(labels):
        name = f"{body}.{label}"
        free = label in chosen[body] and name not in without
        if free and not any(start <= i < start + 4 for start in starts):
            columns.append(scale[i] * np.eye(len(y))[i])
            names.append(name)
    for body, start in zip(turning, starts, strict=True):
        for turn, column in zip(TURNS, _turns(y[start : start + 4]), strict=True):
            if turn in chosen[body]:
                columns.append(np.zeros(len(y)))
                columns[-1][start : start + 4] = column
                names.append(f"{body}.{turn}")
    return np.array(columns).reshape(-1, len(y)).T, tuple(names)


def _turns(q: Floats) -> Floats:
    """Return how a unit quaternion changes with turns about the three axes of its body, shape [3, 4]."""
    w, x, y, z = q
    return 0.5 * np.array([[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]])
