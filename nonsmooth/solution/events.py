"""Events of a run: times, causes, contacts, and changes of modes, velocities and energy."""

from __future__ import annotations

import functools
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.event_rows import CODE_HEAD, EVENT_HEAD, LISTED
from nonsmooth.engine.memory.layout import BOOKED
from nonsmooth.engine.memory.modes import AFTER, BEFORE, CAUSES, CODE, DURING, Cause, word

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
ReadRows: TypeAlias = Callable[[str, int, int | None], NDArray[Any]]
"""``read(name, start, stop)`` gives rows ``start`` to ``stop`` of a column, to its end if ``stop`` is None."""
_BLOCK = 2**14
"""Number of events that are read at once, so that a long run does not fill the memory."""
ENERGIES = ("driven_work", "restitution_loss", "friction_loss", "closing_loss")
"""Columns of the energies of an event [J]."""
_LISTED = ("listed", "codes", "listed_impulse", "listed_memory")
"""Columns with a row for each contact that is listed with an event."""


@final
class _Column(functools.cached_property[NDArray[Any]]):
    """A column of the events: it is read at its first use, and is then an attribute of the events."""

    def __init__(self, description: str) -> None:
        super().__init__(lambda events: events.rows(self.attrname, 0, None))
        self.__doc__ = description


@final
class Events:
    """All events in order of time; several may share an instant.

    The columns of a run with an output folder may be in that folder, and each is read at its first use.  A pickled copy
    has all columns, because the folder may be gone when the copy is used.

    Parameters
    ----------
    n : int
        Number of events.
    n_contacts : int
        Number of contacts of the system.
    read : callable
        ``read(name, start, stop)`` reads rows of a column by its name; with ``stop`` None, to its end.
    """

    time = _Column("Times [s], shape [n].")
    cause = _Column("Members of :class:`nonsmooth.engine.memory.modes.Cause`, shape [n].")
    contact = _Column(
        "Index into ``system.contacts`` of the contact that caused it, or into ``system.guards`` if a guard is the "
        "cause; -1 at the start; shape [n]."
    )
    phases = _Column("Changes of phase within an impact, else 0; shape [n].")
    truncated = _Column("1 if an endless cascade inside an impact was cut short, shape [n].")
    driven_work = _Column("Work of driven bodies in the event [J], shape [n].")
    restitution_loss = _Column("Loss to restitution in the event [J], shape [n].")
    friction_loss = _Column("Loss to friction in the event [J], shape [n].")
    closing_loss = _Column("Loss in closing steps and projections of the event [J], shape [n].")
    q = _Column("Coordinates, shape [n, n_q].")
    u_before = _Column("Velocities before the event, shape [n, n_u].")
    u_after = _Column("Velocities after the event, shape [n, n_u].")
    integrated = _Column(
        "Other integrated quantities after the event: :data:`~nonsmooth.engine.memory.layout.N_ACCOUNTS` energies [J], "
        "then the inner states of laws, contact by contact; shape [n, N_ACCOUNTS + n_states]."
    )
    booked = _Column(
        "Energies accounted in events until then [J]: work of driven bodies, losses by restitution, friction and "
        "closing, shape [n, 4]."
    )
    first = _Column("Row at which the contacts of each event begin in the columns below, shape [n + 1].")
    listed = _Column("Contacts that were closed before, during or after the event, or caused it, shape [n_listed].")
    codes = _Column("Their bits of Eq. (29) before + 8 during + 64 after the event, shape [n_listed].")
    listed_impulse = _Column("Their normal and two tangential impulses [N s], shape [n_listed, 3].")
    listed_memory = _Column(
        "State that each keeps: slip direction, rate of the last closing [m/s], slip direction that an oriented law "
        "faces, mode after the time-stepping fallback, features; shape [n_listed, 8]."
    )

    def __init__(self, n: int, n_contacts: int, read: ReadRows) -> None:
        self.n_contacts, self._n, self._read = n_contacts, n, read

    @classmethod
    def held(cls, n_contacts: int, columns: Mapping[str, NDArray[Any]]) -> Events:
        """Events whose columns are in memory."""
        return cls(len(columns["time"]), n_contacts, lambda name, start, stop: columns[name][start:stop])

    def __reduce__(self) -> tuple[Any, ...]:
        return Events.held, (self.n_contacts, {name: getattr(self, name) for name in COLUMNS})

    def rows(self, name: str, start: int, stop: int | None) -> NDArray[Any]:
        """Rows from ``start`` to ``stop`` of the column ``name``, read without loading the whole column into memory."""
        # after its first use a column is an attribute of this object, so it is not read again
        used = vars(self).get(name)
        return self._read(name, start, stop) if used is None else np.asarray(used[start:stop])

    @classmethod
    def from_buffers(cls, floats: Floats, integers: Integers, n_contacts: int, n_q: int, n_u: int, n_y: int) -> Events:
        """Cut the engine's buffers into columns; ``n_y`` is the length of the integrated state."""
        width = EVENT_HEAD + n_u + n_y + BOOKED
        heads, places, starts = [], [], []
        i = f = 0
        numbers = integers.tolist()
        while i < len(numbers):
            n = numbers[i + CODE_HEAD - 1]
            heads.append(i)
            starts.append(f)
            places.append(n)
            i += CODE_HEAD + 2 * n
            f += width + LISTED * n
        first = np.concatenate([[0], np.cumsum(places, dtype=np.int64)]).astype(np.int64)
        head, start = np.array(heads, dtype=np.int64), np.array(starts, dtype=np.int64)
        row = floats[start[:, None] + np.arange(width)]
        parts = np.cumsum([EVENT_HEAD, n_q, n_u, n_u, n_y - n_q - n_u])
        time_and_energies, q, u_before, u_after, integrated, booked = np.split(row, parts, axis=1)
        # the integers of an event are a head, then two numbers for each listed contact; j numbers the event's contacts
        event = np.repeat(np.arange(len(head)), np.diff(first))
        j = np.arange(int(first[-1])) - first[event]
        pair = head[event] + CODE_HEAD + 2 * j
        push, kept = np.split(floats[(start[event] + width + LISTED * j)[:, None] + np.arange(LISTED)], [3], axis=1)
        columns = {
            "time": time_and_energies[:, 0],
            **{name: integers[head + i] for i, name in enumerate(("cause", "contact", "phases", "truncated"))},
            **{name: time_and_energies[:, i] for i, name in enumerate(ENERGIES, 1)},
            "q": q,
            "u_before": u_before,
            "u_after": u_after,
            "integrated": integrated,
            "booked": booked,
            "first": first,
            "listed": integers[pair],
            "codes": integers[pair + 1],
            "listed_impulse": push,
            "listed_memory": kept,
        }
        return cls.held(n_contacts, columns)

    def blocks(self) -> Iterator[Events]:
        """Iterate over the events in blocks, at least one; only one block of a long run is in memory."""
        n = len(self)
        if n <= _BLOCK:
            yield self
            return
        for start in range(0, n, _BLOCK):
            yield self._block(start, min(start + _BLOCK, n))

    def _block(self, start: int, stop: int) -> Events:
        """Events with the numbers from ``start`` on, up to ``stop`` - 1."""
        first = self.first[start : stop + 1]
        listed = int(first[0]), int(first[-1])

        def read(name: str, low: int, high: int | None) -> NDArray[Any]:
            if name == "first":
                return np.asarray((first - first[0])[low:high])
            begin, end = listed if name in _LISTED else (start, stop)
            return self.rows(name, begin + low, end if high is None else begin + high)

        return Events(stop - start, self.n_contacts, read)

    @classmethod
    def joined(cls, parts: Sequence[Events]) -> Events:
        """Events of several parts of a run; a column is joined when it is first used."""
        if len(parts) == 1:
            return parts[0]
        starts = np.cumsum([0, *map(len, parts)]).tolist()

        def read(name: str, start: int, stop: int | None) -> NDArray[Any]:
            if name == "first":
                sizes = np.concatenate([np.diff(part.first) for part in parts])
                return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)[start:stop]
            if stop is None:
                return np.concatenate([part.rows(name, 0, None) for part in parts])[start:]
            spans = [(part, max(0, start - at), stop - at) for part, at in zip(parts, starts, strict=False)]
            return np.concatenate([part.rows(name, low, max(low, min(high, len(part)))) for part, low, high in spans])

        return cls(starts[-1], parts[0].n_contacts, read)

    def _bits(self, shift: int) -> Integers:
        """Three bits of the code of every contact at every event, from bit ``shift`` on, shape [n, n_contacts]."""
        bits = np.zeros((len(self), self.n_contacts), dtype=np.int64)
        bits[self._event_of_entry(), self.listed] = self.codes >> shift & CODE
        return bits

    def _event_of_entry(self) -> Integers:
        return np.repeat(np.arange(len(self)), np.diff(self.first))

    @functools.cached_property
    def before(self) -> Integers:
        """Sum of each contact's bits before the event, shape [n, n_contacts].

        The bits are closed 1, approaching 2 and slipping 4, Eq. (29) of the paper.
        """
        return self._bits(BEFORE)

    @functools.cached_property
    def during(self) -> Integers:
        """Sum of each contact's bits during the event (1 closed, 2 approaching, 4 slipping), shape [n, n_contacts].

        In an impact, contacts with the bit 2 collide.
        """
        return self._bits(DURING)

    @functools.cached_property
    def after(self) -> Integers:
        """Sum of each contact's bits after the event (1 closed, 2 approaching, 4 slipping), shape [n, n_contacts]."""
        return self._bits(AFTER)

    @functools.cached_property
    def impulse(self) -> Floats:
        """Normal and two tangential impulses per contact [N s], shape [n, n_contacts, 3]."""
        impulse = np.zeros((len(self), self.n_contacts, 3))
        impulse[self._event_of_entry(), self.listed] = self.listed_impulse
        return impulse

    def codes_after(self, numbers: Integers) -> Integers:
        """Sum of the bits of each contact after events with given numbers, shape [n, n_contacts].

        The bits are closed 1, approaching 2, slipping 4.  The number -1 is the time before all events, with bits 0.
        """
        before_all = np.zeros((1, self.n_contacts), np.int64)
        return np.concatenate([self.after, before_all])[numbers]

    def __repr__(self) -> str:
        """Number of events, in all and by cause."""
        causes = ", ".join(f"{n} {cause}" for cause, n in Counter(self.causes()).most_common())
        return f"Events({len(self)}: {causes})" if causes else "Events(0)"

    def __len__(self) -> int:
        return self._n

    def causes(self) -> list[str]:
        """Cause of each event as text, such as "impact"."""
        return [CAUSES[code] for code in self.cause]

    def triggers(self, contacts: Sequence[str], guards: Sequence[str]) -> list[str]:
        """Name of the contact, or of the guard, that caused each event; "" at the start."""
        pairs = zip(self.cause.tolist(), self.contact.tolist(), strict=True)
        return ["" if i < 0 else (guards if cause == Cause.GUARD else contacts)[i] for cause, i in pairs]

    def words(self, which: str) -> list[str]:
        """Mode word of all contacts, such as "{01,00,01}", for each event: "before", "during" or "after" it.

        Its groups are the bits closed, approaching and slipping, with the first contact rightmost in each group.
        """
        codes: Integers = {"before": self.before, "during": self.during, "after": self.after}[which]
        return self.spelled(codes)

    def intervals(self) -> dict[str, int]:
        """Numbers of events by the decade of the time since the event before [s].

        The key "1e-05" counts times from 1e-5 s to below 1e-4 s, the key "0" events at the same instant.
        """
        passed = np.diff(self.time)
        decades = np.floor(np.log10(passed[passed > 0.0])).astype(int)
        found = {"0": int(np.count_nonzero(passed <= 0.0))} | {
            f"1e{decade:+03d}": int(n) for decade, n in zip(*np.unique(decades, return_counts=True), strict=True)
        }
        return {decade: n for decade, n in found.items() if n}

    def count(self, *causes: int) -> int:
        """Number of events with one of the causes."""
        return int(np.isin(self.cause, causes).sum())

    @staticmethod
    def spelled(codes: Integers) -> list[str]:
        """Mode word, such as "{01,00,01}", of each row of ``codes``, shape [n, n_contacts].

        Its groups are the bits closed, approaching and slipping (Eq. (29) of the paper), the first contact rightmost.
        """
        unique, inverse = np.unique(codes, axis=0, return_inverse=True)
        found = [word(list(row & 1), list(row >> 1 & 1), list(row >> 2 & 1)) for row in unique]
        return [found[i] for i in np.ravel(inverse)]


COLUMNS = tuple(name for name, value in vars(Events).items() if isinstance(value, _Column))
"""Names of the columns of :class:`Events`."""
