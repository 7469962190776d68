"""LaidOut: a system laid out in the engine's memory."""

from __future__ import annotations

import functools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from nonsmooth.binding.compile import parameter_names
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import FRAME
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.memory.modes import NOT_FINITE, RUNNING
from nonsmooth.engine.native.kernel import call_entry
from nonsmooth.errors import InvalidInput, PluginError
from nonsmooth.interfaces import Body, ImpactMap
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.model.part_pairs import unwatched
from nonsmooth.model.feature_searches import failed_search
from nonsmooth.system.contact import Contact
from nonsmooth.system.system import System
from nonsmooth.watch import Watch


@dataclass(frozen=True)
class LaidOut:
    """A system laid out in memory, ready to run.

    Attributes
    ----------
    system : System
        What it was made from.
    memory : Memory
        Scalars and heaps.
    n_q, n_u, n_states : int
        Numbers of coordinates and velocities of all bodies, and of the inner states of laws.
    """

    system: System
    memory: Memory
    n_q: int
    n_u: int
    n_states: int

    @property
    def n_y(self) -> int:
        """Length of the integrated state: q, u, accounts, states of laws."""
        return self.n_q + self.n_u + N_ACCOUNTS + self.n_states

    @functools.cached_property
    def sizes(self) -> tuple[int, int, int, int]:
        """Numbers of contacts, coordinates, velocities, and of all that is integrated."""
        return len(self.system.contacts), self.n_q, self.n_u, self.n_y

    @functools.cached_property
    def watch(self) -> Watch:
        """What calls of the engine on its memory are made through that may take long."""
        return Watch(self.memory)

    @functools.cached_property
    def unwatched(self) -> list[int]:
        """Numbers of the contacts at whose pairs of bodies the engine cannot look."""
        return unwatched(self.system.contacts)

    def list_contacts(self) -> None:
        """List the contacts that are near each other at the present state.

        Raises
        ------
        InvalidInput
            If there is no room for so many.
        PluginError
            If a search for features fails.
        """
        status = call_entry("list_contacts", self.memory)
        if status == NOT_FINITE:
            raise PluginError(failed_search(self.memory, self.system.contacts))
        if status != RUNNING:
            raise InvalidInput(
                "contacts of the system",
                f"must not be so many near each other: there is room for {int(self.memory[owners.Model.n_slots])}",
                "more of them",
                "Place the bodies farther apart, or take coarser meshes.",
            )

    def evaluate(self) -> None:
        """Evaluate bodies and contacts at the present state."""
        call_entry("evaluate_at", self.memory)

    def energy(self) -> tuple[float, float]:
        """Return kinetic and potential energy [J] of the present state."""
        self.evaluate()
        bodies = self.system.bodies
        return energies(bodies, self.memory[owners.Body.tail][: len(bodies)], self.memory.floats)

    def places(self) -> list[list[Place]]:
        """Return position [m] and rotation matrix of every frame of every body, as they were evaluated last."""
        found, memory = list[list[Place]](), self.memory
        for body, start in zip(self.system.bodies, memory[owners.Body.out][: len(self.system.bodies)], strict=True):
            width = FRAME + 6 * body.n_u
            frames = memory.floats[start : start + len(body.frames) * width].reshape(-1, width)
            found.append([(frame[:3].copy(), frame[3:12].reshape(3, 3).copy()) for frame in frames])
        return found

    def gaps(self) -> np.ndarray:
        """Return the gaps [m, n_contacts] at the present state; infinite for contacts too far to be listed."""
        self.evaluate()
        n = int(self.memory[owners.Island.n_contacts])
        gaps = np.full(len(self.system.contacts), np.inf)
        listed = self.memory[owners.Contact.geometry][:n][:, 0]
        gaps[self.memory[owners.Contact.declared][:n]] = listed
        return gaps

    def rates(self) -> tuple[np.ndarray, np.ndarray]:
        """Return gaps [m, n_contacts] and relative velocities [m/s, n_contacts x 3] at the present state.

        Those of contacts that are too far to be listed are not a number.
        """
        self.evaluate()
        total, n = len(self.system.contacts), int(self.memory[owners.Island.n_contacts])
        gaps, rates = np.full(total, np.nan), np.full((total, 3), np.nan)
        listed = self.memory[owners.Contact.declared][:n]
        gaps[listed] = self.memory[owners.Contact.geometry][:n][:, 0]
        rates[listed] = self.memory[owners.Contact.rate][:n]
        return gaps, rates


def energies(bodies: tuple[Body, ...], tails: np.ndarray, numbers: np.ndarray) -> tuple[float, float]:
    """Return kinetic and potential energy [J] of bodies that were evaluated; their tails stand there in ``numbers``."""
    kinetic = potential = 0.0
    for body, tail in zip(bodies, tails.tolist(), strict=True):
        if body.n_u > 0:
            energy = tail + body.n_q + body.n_u + body.n_u**2
            kinetic += float(numbers[energy])
            potential += float(numbers[energy + 1])
    return kinetic, potential


def map_width(contacts: Sequence[Contact]) -> int:
    """Return how many numbers a law that maps velocities takes per contact."""
    for contact in contacts:
        if isinstance(contact.impact, ImpactMap):
            return len(parameter_names(contact.impact.impulses, "map"))
    return 1
