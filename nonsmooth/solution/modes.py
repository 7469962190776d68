"""Modes of a run: their shares of the time, the transitions between them with causes, and their graph.

All functions take a solution.  They refuse the run of an engine that records no contacts.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from nonsmooth.engine.memory.modes import AFTER, BEFORE, CODE, DURING, Cause, word
from nonsmooth.histories.replay import check_recorded
from nonsmooth.solution.events import Events

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

ContactModes: TypeAlias = tuple[tuple[int, int], ...]
"""Mode of a system: pairs (number of a contact, sum of its bits), in the order of the contacts, without sums of 0.

The bits are closed 1, approaching 2 and slipping 4, Eq. (29) of the paper.
"""
_CLOSED, _APPROACHING, _SLIPPING = 1, 2, 4
"""Bits in the code of a contact, Eq. (29) of the paper: closed (1), approaching (2) and slipping (4), respectively."""


def are_recorded(solution: Solution) -> bool:
    """True if modes and impulses are known: there are no contacts, or the engine records them."""
    return not solution.system.contacts or solution.recorded.engine.records_contacts


def _check(name: str, solution: Solution) -> None:
    check_recorded(f"nonsmooth.solution.modes.{name}", "modes", solution.system, solution.recorded.engine)


def mode_shares(solution: Solution) -> dict[str, float]:
    """Share of the time in each mode word, the largest first; impacts have no duration and are listed with 0.

    Raises
    ------
    InvalidInput
        The engine of the run records no modes.
    """
    _check("mode_shares", solution)
    events, shares = solution.events, dict[str, float]()
    if len(events) == 0:
        return shares
    durations = np.diff(np.append(events.time, solution.t_end))
    total = float(durations.sum())
    for found, duration in zip(events.words("after"), durations, strict=True):
        shares[found] = shares.get(found, 0.0) + (float(duration) / total if total > 0.0 else 0.0)
    impacts = np.isin(events.cause, (Cause.IMPACT, Cause.PAINLEVE, Cause.JAM))
    for found in events.spelled(events.during[impacts]):
        shares.setdefault(found, 0.0)
    return dict(sorted(shares.items(), key=lambda item: -item[1]))


def transitions(solution: Solution) -> list[tuple[float, str, str, str, str]]:
    """For each event: time [s], cause, and mode word before, during and after it.

    Raises the errors of :func:`mode_shares`.
    """
    _check("transitions", solution)
    events = solution.events
    columns = (events.words(which) for which in ("before", "during", "after"))
    return list(zip(events.time.tolist(), events.causes(), *columns, strict=True))


def triggers(solution: Solution) -> list[str]:
    """Name of the contact, or of the guard, that caused each event; "" at the start."""
    return solution.events.triggers(solution.system.names.contacts, solution.system.names.guards)


@dataclass(frozen=True)
class TransitionGraph:
    """Graph of modes and of the transitions between them.

    An impact is a mode of its own without duration: one transition leads into it, another out of it.

    Attributes
    ----------
    contacts : tuple of str
        Names of the contacts of the system.
    start : ContactModes
        The mode at t = 0.
    shares : mapping of ContactModes to float
        Share of the time spent in each mode, 0 in impacts.
    passing : frozenset of ContactModes
        Modes that occur within impacts only.
    counts : mapping of (ContactModes, ContactModes, str) to int
        Number of transitions from one mode to another by a cause.
    """

    contacts: tuple[str, ...]
    start: ContactModes
    shares: Mapping[ContactModes, float]
    passing: frozenset[ContactModes]
    counts: Mapping[tuple[ContactModes, ContactModes, str], int]

    def __repr__(self) -> str:
        """Numbers of modes and transitions."""
        return f"TransitionGraph({len(self.shares)} modes, {len(self.counts)} transitions)"

    def word(self, mode: ContactModes) -> str:
        """Mode word, such as "{01,00,01}": groups of bits, closed, approaching and slipping, Eq. (29) of the paper.

        Each group has a bit for each contact, with the first contact rightmost.
        """
        rows = [[0] * len(self.contacts) for _ in range(3)]
        for contact, bits in mode:
            for i, row in enumerate(rows):
                row[contact] = bits >> i & 1
        return word(*rows)

    @property
    def nodes(self) -> dict[str, float]:
        """Share of the run's time by mode word ("{01,00,01}"), sorted from the largest share to the smallest."""
        ranked = sorted(self.shares.items(), key=lambda item: -item[1])
        return {self.word(mode): share for mode, share in ranked}

    @property
    def edges(self) -> dict[tuple[str, str, str], int]:
        """Number of transitions by (mode word before, mode word after, cause), the most frequent first."""
        ranked = sorted(self.counts.items(), key=lambda item: -item[1])
        return {(self.word(one), self.word(other), cause): n for (one, other, cause), n in ranked}

    @property
    def visits(self) -> dict[ContactModes, int]:
        """Number of visits of each mode: transitions that lead into it, and 1 more for the mode of the start."""
        visits = dict.fromkeys(self.shares, 0)
        visits[self.start] += 1
        for (_, other, _), n in self.counts.items():
            visits[other] += n
        return visits

    def most_visited(self, limit: int) -> TransitionGraph:
        """Part of the graph with the start and the modes visited most, at most ``limit`` in all."""
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


def transition_graph(solution: Solution) -> TransitionGraph:
    """Modes of a run, their shares of the time, and the number of transitions by each cause.

    A run without events has a single mode with all contacts open.  Raises the errors of :func:`mode_shares`.
    """
    _check("transition_graph", solution)
    events, contacts = solution.events, solution.system.names.contacts
    counts: Counter[tuple[ContactModes, ContactModes, str]] = Counter()
    shares: dict[ContactModes, float] = {}
    passed: dict[ContactModes, None] = {}
    times = [*events.time.tolist(), solution.t_end]
    total = times[-1] - times[0]
    start: ContactModes = ()
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


def _mode(events: Events, event: int, shift: int) -> ContactModes:
    part = slice(int(events.first[event]), int(events.first[event + 1]))
    pairs = zip(events.listed[part].tolist(), events.codes[part].tolist(), strict=True)
    return tuple(sorted((contact, code >> shift & CODE) for contact, code in pairs if code >> shift & CODE))


def grouped(graph: TransitionGraph) -> tuple[TransitionGraph, dict[ContactModes, str]]:
    """Group the modes of a system of many contacts: graph of the groups, and the name of each group.

    Two modes are in one group if their numbers of closed contacts are in the same range (0, 1, 2, 3 to 4, 5 to 8, ...),
    and if in both of them none, some or all of the closed contacts slip.  Impacts are grouped by the range of the
    number of colliding contacts.

    The graph has one mode of each group.  The group with the start mode has the start mode; every other group has its
    mode with the largest share of the time.  Transitions within a group are left out.
    """
    called = {mode: _kind(mode, passing=mode in graph.passing) for mode in graph.shares}
    ranked = sorted(graph.shares, key=lambda mode: (mode != graph.start, -graph.shares[mode]))
    standing = {called[mode]: mode for mode in reversed(ranked)}
    stands_for = {mode: standing[kind] for mode, kind in called.items()}
    shares, counts = dict.fromkeys(standing.values(), 0.0), Counter[tuple[ContactModes, ContactModes, str]]()
    for mode, share in graph.shares.items():
        shares[stands_for[mode]] += share
    for (one, other, cause), n in graph.counts.items():
        # a mode that exists only before an event, because its contacts change their features at this instant, has no
        # share of the time, so it is not in `stands_for`
        before = stands_for.get(one) or standing.get(_kind(one, passing=False))
        if before is not None and before != stands_for[other]:
            counts[before, stands_for[other], cause] += n
    kept = frozenset(stands_for[mode] for mode in graph.passing)
    made = TransitionGraph(graph.contacts, stands_for[graph.start], shares, kept, dict(counts))
    return made, {mode: kind for kind, mode in standing.items()}


def _kind(mode: ContactModes, *, passing: bool) -> str:
    if passing:
        return f"impact, {_range(sum(1 for _, bits in mode if bits & _APPROACHING))} strike"
    closed = sum(1 for _, bits in mode if bits & _CLOSED)
    slipping = sum(1 for _, bits in mode if bits & _SLIPPING)
    if closed == 0:
        return "all open"
    return f"{_range(closed)} closed, {'none' if slipping == 0 else 'all' if slipping == closed else 'some'} slip"


def _range(n: int) -> str:
    """Range that contains a number, of ranges that double in length: "0", "1", "2", "3-4", "5-8", ..."""
    if n <= 2:
        return str(n)
    top = 1 << (n - 1).bit_length()
    return f"{top // 2 + 1}-{top}"
