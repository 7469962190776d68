"""The graph of the modes that a run visited: which, for how long, and what led from one to the next."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TypeAlias

from nonsmooth.engine.memory.modes import AFTER, BEFORE, CODE, DURING, Cause, word
from nonsmooth.solution.events import Events

Mode: TypeAlias = tuple[tuple[int, int], ...]
"""(contact, bits of Eq. (29)) of every contact that is not open, in order: short where contacts are many."""


@dataclass(frozen=True)
class TransitionGraph:
    """Modes and the transitions between them.

    An impact is a mode of its own, which takes no time: one transition leads into it, one out of it.

    Attributes
    ----------
    contacts : tuple of str
        Names of the contacts of the system.
    start : Mode
        The mode at t = 0.
    shares : mapping of Mode to float
        Share of the time spent in each mode, 0 in impacts.
    passing : frozenset of Mode
        The modes that occur within impacts only.
    counts : mapping of (Mode, Mode, str) to int
        How often a mode led to another one, and by which cause.
    """

    contacts: tuple[str, ...]
    start: Mode
    shares: Mapping[Mode, float]
    passing: frozenset[Mode]
    counts: Mapping[tuple[Mode, Mode, str], int]

    def __repr__(self) -> str:
        """Return how much there is of it."""
        return f"TransitionGraph({len(self.shares)} modes, {len(self.counts)} transitions)"

    def word(self, mode: Mode) -> str:
        """Return the mode word of Eq. (29)."""
        rows = [[0] * len(self.contacts) for _ in range(3)]
        for contact, bits in mode:
            for i, row in enumerate(rows):
                row[contact] = bits >> i & 1
        return word(*rows)

    @property
    def nodes(self) -> dict[str, float]:
        """Share of the time by mode word, the largest first."""
        ranked = sorted(self.shares.items(), key=lambda item: -item[1])
        return {self.word(mode): share for mode, share in ranked}

    @property
    def edges(self) -> dict[tuple[str, str, str], int]:
        """Number of transitions by (mode word before, mode word after, cause), the most frequent first."""
        ranked = sorted(self.counts.items(), key=lambda item: -item[1])
        return {(self.word(one), self.word(other), cause): n for (one, other, cause), n in ranked}

    @property
    def visits(self) -> dict[Mode, int]:
        """How often the run came to each mode, its start included."""
        visits = dict.fromkeys(self.shares, 0)
        visits[self.start] += 1
        for (_, other, _), n in self.counts.items():
            visits[other] += n
        return visits

    def most_visited(self, limit: int) -> TransitionGraph:
        """Return the part of the graph with the modes visited most, at most ``limit`` and the start among them."""
        visits = self.visits
        ranked = sorted(self.shares, key=lambda mode: (mode != self.start, -visits[mode], -self.shares[mode]))
        kept = set(ranked[:limit])
        return TransitionGraph(
            self.contacts,
            self.start,
            {mode: share for mode, share in self.shares.items() if mode in kept},
            self.passing & kept,
            {edge: n for edge, n in self.counts.items() if edge[0] in kept and edge[1] in kept},
        )


def transition_graph(events: Events, contacts: tuple[str, ...], t_end: float) -> TransitionGraph:
    """Return the graph of a run that reached ``t_end`` [s]; one mode, open, where nothing was recorded."""
    counts: Counter[tuple[Mode, Mode, str]] = Counter()
    shares: dict[Mode, float] = {}
    passed: dict[Mode, None] = {}
    times = [*events.time.tolist(), t_end]
    total = times[-1] - times[0]
    start: Mode = ()
    for k, (code, cause) in enumerate(zip(events.cause.tolist(), events.causes(), strict=True)):
        before, during, after = (_mode(events, k, shift) for shift in (BEFORE, DURING, AFTER))
        duration = times[k + 1] - times[k]
        shares[after] = shares.get(after, 0.0) + (duration / total if total > 0.0 else 0.0)
        if code == Cause.START:
            start = after
        elif during in (before, after):
            counts[before, after, cause] += 1
        else:
            passed[during] = None
            counts[before, during, cause] += 1
            counts[during, after, cause] += 1
    if not shares:
        shares[start] = 1.0
    passing = frozenset(mode for mode in passed if mode not in shares)
    return TransitionGraph(contacts, start, dict.fromkeys(passed, 0.0) | shares, passing, dict(counts))


def _mode(events: Events, event: int, shift: int) -> Mode:
    part = slice(int(events.first[event]), int(events.first[event + 1]))
    pairs = zip(events.listed[part].tolist(), events.codes[part].tolist(), strict=True)
    return tuple(sorted((contact, code >> shift & CODE) for contact, code in pairs if code >> shift & CODE))
