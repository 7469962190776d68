"""LaidOut: a system in the memory of the engine, and the quantities that are read from there.

An active contact is a declared contact on the neighbour list. The others belong to bodies that are far apart.
"""

from __future__ import annotations

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import FRAME, GAP
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import Status
from nonsmooth.engine.native.kernel import PLAIN, call_entry
from nonsmooth.errors import InvalidInput, PluginError
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.model.feature_searches import failed_search
from nonsmooth.model.part_pairs import contacts_without_parts
from nonsmooth.system.system import System
from nonsmooth.watch import Watch


@dataclass(frozen=True)
class LaidOut:
    """A system in the memory of the engine.

    Attributes
    ----------
    system : System
        The system.
    memory : Memory
        The workspace of the engine.
    slot_counts : callable
        Gives the counts that follow from a number of slots for active contacts, by name.
    n_q, n_u, n_states : int
        Numbers of coordinates and velocities of all bodies, and of inner states of laws.
    marks : array
        Places, among the floats of the memory, of the marks behind blocks (:mod:`nonsmooth.model.blocks`).
    """

    system: System
    memory: Memory
    slot_counts: Callable[[int], Mapping[str, int]]
    n_q: int
    n_u: int
    n_states: int
    marks: NDArray[np.int64]

    @property
    def active(self) -> NDArray[np.int64]:
        """Number of the declared contact of each active contact, a view."""
        return cast(
            NDArray[np.int64], self.memory[owners.ContactRecord.declared][: self.memory[owners.Island.n_contacts]]
        )

    @property
    def n_y(self) -> int:
        """Length of the integrated state: q, u, energy accounts, inner states of laws."""
        return self.n_q + self.n_u + N_ACCOUNTS + self.n_states

    @functools.cached_property
    def sizes(self) -> tuple[int, int, int, int]:
        """Numbers of contacts, coordinates, velocities and integrated numbers, by which recorded events are read."""
        return len(self.system.contacts), self.n_q, self.n_u, self.n_y

    @functools.cached_property
    def watch(self) -> Watch:
        """Object that makes calls of the engine that may take long: it reports progress, and Ctrl-C stops them."""
        return Watch(self.memory)

    @functools.cached_property
    def contacts_without_parts(self) -> list[int]:
        """Numbers of the contacts of shapes without convex parts, whose bodies the engine cannot check for overlap."""
        return contacts_without_parts(self.system.contacts)

    def list_contacts(self, of_all: bool = True) -> None:
        """Make the neighbour list at the current state: the active contacts, those of bodies near each other.

        The memory grows if it has too few slots for them.

        Parameters
        ----------
        of_all : bool
            False to leave out the contacts of convex shapes that are apart, as the engine does in a run.

        Raises
        ------
        InvalidInput
            If a search finds more features near each other than there are contacts for them.
        PluginError
            If a search for features fails.
        """
        name = "list_near" if of_all else "list_touching"
        status = call_entry(name, self.memory)
        while status == Status.LIST_FULL:
            self.reserve(2 * int(self.memory[owners.ModelNumbers.n_slots]) + 1)
            status = call_entry(name, self.memory)
        if status == Status.NOT_FINITE:
            raise PluginError(failed_search(self.memory, self.system.contacts))
        if status != Status.RUNNING:
            raise InvalidInput(
                "contacts of the system",
                "must be enough for the pairs of features that are near each other",
                "more pairs",
                "Place the bodies farther apart, or take coarser meshes.",
            )

    def reserve(self, n_slots: int) -> None:
        """Enlarge the memory to slots for ``n_slots`` active contacts, at most all declared ones, if it has fewer."""
        n = min(n_slots, len(self.system.contacts))
        if n > self.memory[owners.ModelNumbers.n_slots]:
            self.resize(n)

    def resize(self, n_slots: int) -> None:
        """Set the number of slots for active contacts. Former views of the memory do not show the new one."""
        if n_slots != self.memory[owners.ModelNumbers.n_slots]:
            self.memory.resize({**self.memory.counts, **self.slot_counts(n_slots)})

    def evaluate(self) -> None:
        """Evaluate bodies and active contacts at the current state, and write their blocks in the memory."""
        call_entry("evaluate_at", self.memory)

    def energy(self) -> tuple[float, float]:
        """Kinetic and potential energy [J] at the current state. Evaluates bodies and contacts."""
        self.evaluate()
        return energies(self.system.bodies, self.memory[owners.BodyRecord.tail], self.memory.floats)

    def places(self) -> list[list[Place]]:
        """Copies of position [m] and rotation matrix of each frame of each body, as they were evaluated last.

        A frame has its motion and a Jacobian of 6 rows in the output block of the body. It begins with the position (3
        numbers) and the rotation (9).
        """
        found, memory = list[list[Place]](), self.memory
        for body, start in zip(self.system.bodies, memory[owners.BodyRecord.out], strict=True):
            width = FRAME + 6 * body.n_u
            frames = memory.floats[start : start + len(body.frames) * width].reshape(-1, width)
            found.append([(frame[:3].copy(), frame[3:12].reshape(3, 3).copy()) for frame in frames])
        return found

    def gaps(self) -> np.ndarray:
        """Gaps [m] at the current state, shape [n_contacts]; infinite for contacts that are not active.

        Evaluates bodies and contacts. Active contacts belong to bodies near each other.
        """
        self.evaluate()
        gaps, active = np.full(len(self.system.contacts), np.inf), self.active
        gaps[active] = self.memory[owners.ContactRecord.geometry][: len(active), GAP]
        return gaps

    def rates(self) -> tuple[np.ndarray, np.ndarray]:
        """Gaps [m] and relative velocities [m/s] at the current state, shapes [n_contacts] and [n_contacts, 3].

        The velocities are along n, t1, t2. Both are NaN for contacts that are not active, which are not on the
        neighbour list. Evaluates bodies and contacts.
        """
        # evaluates the contacts, whose rates are read below, so it comes first
        gaps = self.gaps()
        active = self.active
        # of the contacts that are not active
        gaps[np.delete(np.arange(len(gaps)), active)] = np.nan
        rates = np.full((len(gaps), 3), np.nan)
        # the memory holds the active contacts only, in the order of the list
        rates[active] = self.memory[owners.ContactRecord.rate][: len(active)]
        return gaps, rates


def energies(bodies: tuple[Body, ...], rates: np.ndarray, numbers: np.ndarray) -> tuple[float, float]:
    """Kinetic and potential energy [J] of all bodies, read from ``numbers``.

    ``numbers`` are all floats of a memory, or the blocks of a checkpoint. ``rates`` has, for each body, the place of
    its q' there; force, inverse mass and the energies follow. Driven bodies have no energy.
    """
    kinetic = potential = 0.0
    for body, start in zip(bodies, rates.tolist(), strict=True):
        if body.n_u > 0:
            energy = start + body.n_q + body.n_u + body.n_u**2
            kinetic += float(numbers[energy])
            potential += float(numbers[energy + 1])
    return kinetic, potential


def copied(model: LaidOut) -> LaidOut:
    """Layout with the same content in a memory of its own, for another thread.

    Tables of functions are shared. A function finds its table by a distance [floats] from the start of its parameters.
    In a copy this distance leads into the memory with the tables, because pointers in compiled code have no bounds.
    Without compiled code (``PLAIN``) arrays with bounds replace the pointers, so the tables are copied.
    """
    return replace(model, memory=model.memory.copied(shares_tables=not PLAIN))
