"""The events of a run: when, why, where, and what they did to modes and energy."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.modes import CAUSES, word
from nonsmooth.engine.record import CODE_HEAD, EVENT_HEAD

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Events:
    """All events in order of time; several may share an instant.

    Attributes
    ----------
    time : array
        [s], shape [n].
    cause : array
        Index into :data:`nonsmooth.engine.modes.CAUSES`, shape [n].
    contact : array
        The contact that caused it, counted from 0, -1 at the start; the number of the guard where that is the
        cause; shape [n].
    phases : array
        Changes of phase within an impact, else 0; shape [n].
    truncated : array
        1 where an endless cascade inside an impact was cut short, shape [n].
    before, during, after : array
        Bits a + 2 b + 4 c of Eq. (29) per contact, shape [n, n_contacts]; ``during`` differs from ``before``
        in an impact, where it shows who collides.
    driven_work, restitution_loss, friction_loss, closing_loss : array
        Energies of the event [J], shape [n].
    impulse : array
        Normal and two tangential impulses per contact [N s], shape [n, n_contacts, 3].
    q : array
        Coordinates, shape [n, n_q].
    u_before, u_after : array
        Velocities, shape [n, n_u].
    """

    time: Floats
    cause: Integers
    contact: Integers
    phases: Integers
    truncated: Integers
    before: Integers
    during: Integers
    after: Integers
    driven_work: Floats
    restitution_loss: Floats
    friction_loss: Floats
    closing_loss: Floats
    impulse: Floats
    q: Floats
    u_before: Floats
    u_after: Floats

    @classmethod
    def from_rows(cls, rows: Floats, codes: Integers, n_contacts: int, n_q: int, n_u: int) -> Events:
        """Cut the engine's rows into columns."""
        ends = np.cumsum([EVENT_HEAD, 3 * n_contacts, n_q, n_u])
        head, impulse, q, u_before, u_after = np.split(rows, ends, axis=1)
        bits = codes[:, CODE_HEAD:]
        return cls(
            head[:, 0],
            codes[:, 0],
            codes[:, 1],
            codes[:, 2],
            codes[:, 3],
            bits % 8,
            bits // 8 % 8,
            bits // 64,
            head[:, 1],
            head[:, 2],
            head[:, 3],
            head[:, 4],
            impulse.reshape(len(rows), n_contacts, 3),
            q,
            u_before,
            u_after,
        )

    def __len__(self) -> int:
        return len(self.time)

    def causes(self) -> list[str]:
        """Return the causes in words."""
        return [CAUSES[code] for code in self.cause]

    def words(self, which: str) -> list[str]:
        """Return the mode words ``before``, ``during`` or ``after`` every event."""
        codes: Integers = {"before": self.before, "during": self.during, "after": self.after}[which]
        return words(codes)

    def count(self, *causes: int) -> int:
        """Return how many events have one of the causes."""
        return int(np.isin(self.cause, causes).sum())


def words(codes: Integers) -> list[str]:
    """Return the mode word of every row of bits."""
    unique, inverse = np.unique(codes, axis=0, return_inverse=True)
    spelled = [word(list(row & 1), list(row >> 1 & 1), list(row >> 2 & 1)) for row in unique]
    return [spelled[i] for i in np.ravel(inverse)]
