"""Chart: directions in which a state can change while quaternions stay unit and closed contacts stay closed."""

from __future__ import annotations

import dataclasses
from collections.abc import Collection
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.modes import Mode
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import RigidNormalLaw, StatefulFrictionLaw, TractionLaw
from nonsmooth.runs.model import Model
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.coordinates import (
    TURNS,
    labels_of,
    labels_within,
    quaternions_of,
    scales_of,
    values_of,
)
from nonsmooth.system.system import System
from nonsmooth.types import Array

_PROBE = 1e-6
"""Step of the central differences of gaps and gap rates, in units of the scales of the bodies."""
_DEPENDS = 1e-6
"""Relative size of a number that counts as zero, because derivatives by differences have errors.

A derivative of a gap or gap rate is zero if it is below this part of the largest derivative.  A direction depends on
other directions if its component independent of them is below this part of its length.
"""
_EARLIER = 0.1
"""Least derivative, relative to the largest, of a direction that a closed contact eliminates.

The first direction with such a derivative is eliminated, not the one with the largest derivative.  So neighbouring
states eliminate the same directions.
"""
_MOST = 20
"""Largest number of steps of Newton's method that make a state fulfil the constraints of its closed contacts."""


@final
@dataclass(frozen=True)
class ClosedConstraints:
    """The closed contacts with a rigid normal law at a state; they constrain how the state can change.

    Attributes
    ----------
    closed, stuck : array
        Numbers of the closed contacts, and of the closed contacts that stick, shapes [n_closed] and [n_stuck].
    """

    closed: NDArray[np.int64]
    stuck: NDArray[np.int64]

    @classmethod
    def at(cls, model: Model, state: State) -> ClosedConstraints:
        """Return the closed contacts of a state.

        Raises
        ------
        InvalidInput
            If the friction law of a closed contact has states of its own, which a chart does not contain.
        """
        contacts = model.system.contacts
        for number in np.flatnonzero(state.modes != Mode.OPEN).tolist():
            if isinstance(contacts[number].friction, (StatefulFrictionLaw, TractionLaw)):
                rule = "must be open there, as its law has inner states"
                remedy = "Choose a section where it is open, or a law without inner states."
                raise InvalidInput(f"section: the {contacts[number]}", rule, "closed", remedy)
        rigid = np.array([isinstance(contact.normal, RigidNormalLaw) for contact in contacts], dtype=bool)
        closed = rigid & (state.modes != Mode.OPEN)
        return cls(np.flatnonzero(closed), np.flatnonzero(closed & (state.modes == Mode.STICK)))

    def residual(self, model: Model, state: State) -> Array:
        """Return gaps [m] and gap rates [m/s] of closed contacts, and slip velocities of sticking contacts [m/s]."""
        gaps, rates = model.contact_rates(state)
        return np.concatenate([gaps[self.closed], rates[self.closed, 0], rates[self.stuck, 1:].ravel()])


@final
@dataclass(frozen=True)
class Chart:
    """Directions about a state, in units of the scales of the bodies.

    Each closed contact eliminates directions.  A state moves freely along the remaining directions.  It is corrected
    along the eliminated directions, so that closed gaps stay zero and sticking contacts have no slip.

    Attributes
    ----------
    basis : array
        Free directions, one in each column, shape [n_q + n_u, m].
    names : tuple of str
        The coordinate, velocity or rotation of a body ("ball.rx" about its own x axis) that each direction changes.
    quaternions : tuple of int
        Index in q of the first component of each quaternion.
    contacts : ClosedConstraints
        The closed contacts.
    following : array
        Eliminated directions, along which closed contacts determine the state, shape [n_q + n_u, k].
    inverse : array
        Pseudo-inverse of the derivatives of gaps and rates along the eliminated directions, shape [k, n_residual].
    ignored : array
        Directions along which states are taken as equal, for example by a symmetry, shape [n_q + n_u, s].
    """

    basis: Array
    names: tuple[str, ...]
    quaternions: tuple[int, ...]
    contacts: ClosedConstraints
    following: Array
    inverse: Array
    ignored: Array

    @classmethod
    def at(
        cls,
        model: Model,
        state: State,
        within: Collection[str] | None = None,
        without: Collection[str] = (),
        ignored: Array | None = None,
    ) -> Chart:
        """Return the directions about a state.

        Parameters
        ----------
        model : Model
            The model.
        state : State
            The state.
        within : collection of str, optional
            Names of the coordinates and velocities that may change ("z", or "ball.z" for one body), and of turns about
            a body's own axes ("rx", "ry", "rz"); all by default.
        without : collection of str
            Names of constant coordinates and velocities, each with its body ("ball.z").
        ignored : array, optional
            Directions along which states are taken as equal, for example by a symmetry, shape [n_q + n_u, s].

        Raises
        ------
        UnknownName
            If `within` contains an unknown name.
        InvalidInput
            If the friction law of a closed contact has states of its own, or a contact is closed and no coordinate or
            velocity may change.
        """
        contacts, quaternions = ClosedConstraints.at(model, state), tuple(quaternions_of(model.system).values())
        columns, names = _columns(model.system, state, within, without)
        # of an ignored direction, use only the components along coordinates that may change
        changes = np.any(columns, axis=1)[:, None]
        same = np.zeros((len(columns), 0)) if ignored is None else np.where(changes, ignored, 0.0)
        kept = _independent(columns, same)
        columns, names = columns[:, kept], tuple(names[i] for i in kept)
        if not names and len(contacts.closed):
            rule = (
                "must leave a coordinate or velocity free besides the one of the section, as contacts are closed there"
            )
            raise InvalidInput("section: within", rule, within, "Name more coordinates, or choose another section.")
        whole = cls(columns, names, quaternions, contacts, columns[:, :0], np.zeros((0, 0)), same)
        rows = whole._slopes(model, state)
        follow = _eliminated(rows)
        free = [i for i in range(len(names)) if i not in follow]
        inverse = np.asarray(np.linalg.pinv(rows[:, follow], rcond=_DEPENDS), dtype=np.float64)
        chosen = tuple(names[i] for i in free)
        return cls(columns[:, free], chosen, quaternions, contacts, columns[:, follow], inverse, same)

    def moved(self, model: Model, state: State, way: Array) -> State:
        """Return a state moved by steps along the free directions, shape [m], then corrected by :meth:`held_in`."""
        return self.held_in(model, self._stepped(state, self.basis @ way))

    def held_in(self, model: Model, state: State) -> State:
        """Return a state corrected by Newton's method, so that its closed contacts fulfil their constraints.

        Only the coordinates and velocities along the eliminated directions (``following``) change.  The gaps and gap
        rates of closed contacts, and the slip velocities of sticking contacts, become zero up to round-off.
        """
        if not self.following.size:
            return state
        left = self.contacts.residual(model, state)
        for _ in range(_MOST):
            there = self._stepped(state, -self.following @ (self.inverse @ left))
            smaller = self.contacts.residual(model, there)
            if not np.max(np.abs(smaller)) < np.max(np.abs(left)):
                break
            state, left = there, smaller
        return state

    def between(self, one: State, two: State) -> Array:
        """Return the difference of two states along the free directions, as coefficients of ``basis``, shape [m]."""
        columns = np.column_stack([self.basis, self.ignored])
        return self._along(columns, one, two)[: self.basis.shape[1]]

    def following_between(self, one: State, two: State) -> Array:
        """Return the difference of two states along the eliminated directions, shape [k].

        Closed contacts determine the state along these directions.  The numbers are coefficients of ``following``.
        """
        columns = np.column_stack([self.following, self.basis, self.ignored])
        return self._along(columns, one, two)[: self.following.shape[1]]

    def _along(self, columns: Array, one: State, two: State) -> Array:
        """Return the coefficients with which ``columns`` best give the difference of two states, by least squares."""
        q = two.q.copy()
        for start in self.quaternions:
            # an orientation has two quaternions, q and -q, and a full turn swaps them: take the nearer one
            if q[start : start + 4] @ one.q[start : start + 4] < 0.0:
                q[start : start + 4] *= -1.0
        return np.asarray(np.linalg.lstsq(columns, np.concatenate([q - one.q, two.u - one.u]), rcond=None)[0])

    def _stepped(self, state: State, change: Array) -> State:
        x = values_of(state) + change
        for start in self.quaternions:
            x[start : start + 4] /= np.linalg.norm(x[start : start + 4])
        return dataclasses.replace(state, q=x[: len(state.q)], u=x[len(state.q) :])

    def _slopes(self, model: Model, state: State) -> Array:
        """Return derivatives of the closed contacts' residual along each column of ``basis``, [n_residual, m].

        The residual contains their gaps [m], gap rates [m/s] and slip velocities [m/s].  Derivatives are central
        differences.
        """

        def left(change: Array) -> Array:
            return self.contacts.residual(model, self._stepped(state, change))

        found = [(left(_PROBE * way) - left(-_PROBE * way)) / (2.0 * _PROBE) for way in self.basis.T]
        return np.array(found).reshape(len(found), -1).T if len(self.contacts.closed) else np.zeros((0, len(found)))


def _eliminated(rows: Array) -> list[int]:
    """Return the indices of the directions that closed contacts determine, one for each independent constraint.

    ``rows`` are the derivatives of the constraints along all directions, shape [n_residual, m].  The method is
    Gram-Schmidt with pivots.
    """
    # rows are normalised, because gaps and rates have different units
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


def _independent(columns: Array, same: Array) -> list[int]:
    """Return the sorted indices of columns that are independent of each other and of the columns of ``same``."""
    basis, kept = np.linalg.qr(same)[0], list[int]()
    while True:
        left = columns - basis @ (basis.T @ columns)
        parts = np.linalg.norm(left, axis=0) / np.linalg.norm(columns, axis=0)
        parts[kept] = 0.0
        i = int(np.argmax(parts)) if len(parts) else 0
        if not len(parts) or parts[i] <= _DEPENDS:
            return sorted(kept)
        kept.append(i)
        basis = np.column_stack([basis, left[:, i] / np.linalg.norm(left[:, i])])


def _columns(
    system: System, state: State, within: Collection[str] | None, without: Collection[str]
) -> tuple[Array, tuple[str, ...]]:
    """Return all directions in which a state may change, shape [n_q + n_u, m], and their names."""
    chosen, scale = labels_within(system, within), scales_of(system)
    y, quaternions = values_of(state), quaternions_of(system)
    columns, names = list[Array](), list[str]()
    for i, (body, label, _) in enumerate(labels_of(system)):
        name = f"{body}.{label}"
        free = label in chosen[body] and name not in without
        if free and not any(start <= i < start + 4 for start in quaternions.values()):
            columns.append(scale[i] * np.eye(len(y))[i])
            names.append(name)
    for body, start in quaternions.items():
        for turn, column in zip(TURNS, _turns(y[start : start + 4]), strict=True):
            if turn in chosen[body]:
                columns.append(np.zeros(len(y)))
                columns[-1][start : start + 4] = column
                names.append(f"{body}.{turn}")
    return np.array(columns).reshape(-1, len(y)).T, tuple(names)


def _turns(q: Array) -> Array:
    """Return the derivative of a unit quaternion by the angle [rad] about each body axis, shape [3, 4]."""
    w, x, y, z = q
    return 0.5 * np.array([[-x, w, z, -y], [-y, -z, w, x], [-z, y, -x, w]])
