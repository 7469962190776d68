"""Result of a contact problem: forces, accelerations and modes, and whether they are unique."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import StrEnum
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.layout import SINGULAR
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.solvers import Solver
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.problems.matrices import read_delassus

Floats = NDArray[np.float64]


class ContactMode(StrEnum):
    """Mode of a contact at an instant of sustained contact; the order is that of the engine's numbers 0, 1, 2."""

    OPEN = "open"
    """The gap is positive, or it is zero and begins to grow."""
    STICK = "stick"
    """The contact is closed, and friction holds it."""
    SLIDE = "slide"
    """The contact is closed and slips, or begins to slip."""


_MOST_SEARCHED = 6
_SAME = 1e-8


@dataclass(frozen=True)
class ContactResult:
    """Forces, accelerations and modes at an instant of sustained contact.

    Attributes
    ----------
    normal_force : array
        Normal force of every contact [N], shape [n].
    tangential_force : array
        Friction force of every contact [N], shape [n, 2].
    acceleration : array
        Generalised accelerations u', shape [n_u].
    contact_acceleration : array
        Second derivative of the gap and rate of the slip velocity [m/s^2], shape [n, 3].
    modes : tuple of ContactMode
        Mode of every contact, length n. Each is a str, too: "open", "stick" or "slide".

    If several sets of forces give the same motion, the result is the set of least norm.  A contact whose force in this
    set would pull the bodies together is left open.  If the set breaks Coulomb's bound, the result is a set near it
    that keeps the bound.
    """

    normal_force: Floats
    tangential_force: Floats
    acceleration: Floats
    contact_acceleration: Floats
    modes: tuple[ContactMode, ...]
    _memory: Memory = field(repr=False, compare=False)
    _scaled: Floats = field(repr=False, compare=False)

    @property
    def _size(self) -> float:
        """Size of the terms whose sum is a contact acceleration [m/s^2]: the round-off of the sum is relative to it."""
        delassus = read_delassus(self._memory, len(self.modes))
        return max(float(np.max(np.abs(delassus))) * float(np.max(np.abs(self.normal_force))), 1e-300)

    @cached_property
    def null_space(self) -> Floats:
        """Basis of the changes of the forces that do not change the motion [N], shape [k, n, 3].

        It is orthonormal in the free components of the forces.  A contact at rest that sticks, or touches without
        separating, has three of them.  A contact that slides has one: its normal force, with friction in proportion.
        A contact that separates has no free component.
        """
        n = len(self.modes)
        mu, d = (
            self._memory[owners.ActiveContact.friction_coefficient][:n],
            self._memory[owners.ActiveContact.direction][:n],
        )
        at_rest = self._memory[owners.ActiveContact.is_at_rest][:n]
        free = []
        for i, mode in enumerate(self.modes):
            column = np.zeros((3, n, 3))
            column[:, i] = np.eye(3)
            touching = mode == ContactMode.OPEN and self.contact_acceleration[i, 0] <= _SAME * self._size
            if mode == ContactMode.SLIDE or (touching and at_rest[i] == 0):
                column[0, i, 1:] = -mu[i] * d[i]
                free.append(column[:1])
            elif mode != ContactMode.OPEN or touching:
                free.append(column)
        if not free:
            return np.zeros((0, n, 3))
        basis = np.concatenate(free)
        _, sigma, rows = np.linalg.svd(self._scaled @ basis.reshape(len(basis), 3 * n).T)
        rank = int(np.sum(sigma > SINGULAR * sigma.max(initial=0.0)))
        return np.tensordot(rows[rank:], basis, axes=1)

    @property
    def forces_are_unique(self) -> bool:
        """Whether only these forces give this motion, because :attr:`null_space` is empty.

        True is a proof.  If it is False, other forces usually give the same motion.  In rare cases the forces are
        unique all the same: a force at its bound can change with one sign only, and such bounds may exclude every
        direction of the null space.
        """
        return len(self.null_space) == 0

    @cached_property
    def proved_unique(self) -> bool:
        r"""True if a criterion proves that the motion is unique.  If G is regular, the forces are then unique, too.

        For two solutions, f and f' with accelerations a and a', Eqs. (16) and (17) with mu_s = mu give

            (f - f') . G (f - f')  <=  sum of mu_i |a_T - a_T'|_i |f_N - f_N'|_i

        Without friction the right-hand side is zero, and so is G (f - f'), as G is positive semidefinite: the motion is
        unique.  With friction and a regular G the right-hand side is at most s times the left-hand side, where
        s^2 = (largest eigenvalue of G_TT) (largest eigenvalue of D (G^-1)_NN D), D = diag(mu).  So motion and forces
        are unique if s < 1.
        """
        n = len(self.modes)
        mu = self._memory[owners.ActiveContact.friction_coefficient][:n]
        static = self._memory[owners.ActiveContact.static_coefficient][:n]
        if np.any((static != mu) & (self._memory[owners.ActiveContact.is_at_rest][:n] == 1)):
            return False
        if not np.any(mu > 0.0):
            return True
        delassus = read_delassus(self._memory, n)
        values, vectors = np.linalg.eigh(delassus)
        if values[0] <= SINGULAR * values[-1]:
            return False
        normal = np.arange(3 * n) % 3 == 0
        half = (vectors[normal] * mu[:, None]) / np.sqrt(values)
        tangent = delassus[np.ix_(~normal, ~normal)]
        return bool(np.linalg.norm(half, 2) ** 2 * np.linalg.eigvalsh(tangent)[-1] < 1.0)

    @cached_property
    def motion_is_unique(self) -> bool | None:
        """True if only this motion fulfils the laws, False if another motion does, None if this is not known.

        1. The result is True if :attr:`proved_unique` is True.
        2. Otherwise, for more than six contacts, the result is None.
        3. Otherwise all combinations of modes are searched and all solvers are run.  The result is False if they find
           another motion, else True.

        The search of step 3 is complete if the directions of all slips are given.  It may miss a motion in which a
        contact at rest starts to slide, because it finds the direction from several initial guesses.  It omits unstable
        motions, in which more normal force at a sliding contact causes more approach.
        """
        if self.proved_unique:
            return True
        n = len(self.modes)
        if n > _MOST_SEARCHED:
            return None
        small = _SAME * self._size
        whole = {name: getattr(self._memory, name).copy() for name in ("scalars", "floats", "integers")}
        trial = replace(self._memory, **whole)
        trial[owners.ActiveContact.mode_past][:n][:] = -1
        number = 0
        while number := int(call_entry("enumerate_modes", trial, number)):
            if self._differs(trial, small):
                return False
        for solver in (Solver.LEMKE, Solver.GAUSS_SEIDEL, Solver.NEWTON):
            if call_entry("find_modes", trial, solver) == 1 and self._differs(trial, small):
                return False
        return True

    def _differs(self, trial: Memory, small: float) -> bool:
        n = len(self.modes)
        delassus = read_delassus(trial, n)
        acceleration = (
            delassus @ trial[owners.Problem.forces][: 3 * n] + trial[owners.Problem.free_accelerations][: 3 * n]
        )
        return float(np.max(np.abs(acceleration - self.contact_acceleration.ravel()))) > small
