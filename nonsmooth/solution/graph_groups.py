"""Modes of many contacts as kinds of modes: how many contacts are closed or strike, whether some slip."""

from __future__ import annotations

from collections import Counter

from nonsmooth.solution.graph import Mode, TransitionGraph

_CLOSED, _APPROACHING, _SLIPPING = 1, 2, 4
"""Bits of Eq. (29)."""


def grouped(graph: TransitionGraph) -> tuple[TransitionGraph, dict[Mode, str]]:
    """Return a graph with one mode for each kind of modes, and what the kinds are called.

    A kind has 0, 1, 2, 3 to 4, 5 to 8, ... closed contacts, of which none, some or all slip; one of impacts as many
    that strike.  It is stood for by its mode that lasts longest; what led from one mode of a kind to another of the
    same is left out.
    """
    called = {mode: _kind(mode, passing=mode in graph.passing) for mode in graph.shares}
    ranked = sorted(graph.shares, key=lambda mode: (mode != graph.start, -graph.shares[mode]))
    standing = {called[mode]: mode for mode in reversed(ranked)}
    stands_for = {mode: standing[kind] for mode, kind in called.items()}
    shares, counts = dict.fromkeys(standing.values(), 0.0), Counter[tuple[Mode, Mode, str]]()
    for mode, share in graph.shares.items():
        shares[stands_for[mode]] += share
    for (one, other, cause), n in graph.counts.items():
        # a mode in which contacts change their features right away is not among those that lasted
        before = stands_for.get(one) or standing.get(_kind(one, passing=False))
        if before is not None and before != stands_for[other]:
            counts[before, stands_for[other], cause] += n
    kept = frozenset(stands_for[mode] for mode in graph.passing)
    made = TransitionGraph(graph.contacts, stands_for[graph.start], shares, kept, dict(counts))
    return made, {mode: kind for kind, mode in standing.items()}


def _kind(mode: Mode, *, passing: bool) -> str:
    if passing:
        return f"impact, {_range(sum(1 for _, bits in mode if bits & _APPROACHING))} strike"
    closed = sum(1 for _, bits in mode if bits & _CLOSED)
    slipping = sum(1 for _, bits in mode if bits & _SLIPPING)
    if closed == 0:
        return "all open"
    return f"{_range(closed)} closed, {'none' if slipping == 0 else 'all' if slipping == closed else 'some'} slip"


def _range(n: int) -> str:
    """Return the doubling that a number is in: "0", "1", "2", "3-4", "5-8", ..."""
    if n <= 2:
        return str(n)
    top = 1 << (n - 1).bit_length()
    return f"{top // 2 + 1}-{top}"
