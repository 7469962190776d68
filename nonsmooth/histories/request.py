"""Request for a history: the run, the times, and the parts of the system."""

from __future__ import annotations

import functools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeAlias, final

import numpy as np
from numpy.typing import ArrayLike

from nonsmooth.errors import InvalidInput, UnknownName
from nonsmooth.histories.arrays import Floats, Integers
from nonsmooth.histories.replay import StateReplay, replay_of
from nonsmooth.interfaces import Body
from nonsmooth.system.contact import Contact, Tie
from nonsmooth.system.system import System

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

Part: TypeAlias = Contact | Body | Tie | str | int
"""A contact, body or joint: the object, its name, or its number in the system, from 0."""
Parts: TypeAlias = Part | Sequence[Part] | Integers
"""A contact, body or joint, or several."""


@final
@dataclass(frozen=True)
class HistoryRequest:
    """A run, times within it, and chosen contacts, bodies and joints of its system.

    Attributes
    ----------
    solution : Solution
        The run.
    times : array
        Times within the run [s], in any order, shape [n].
    chosen : mapping of str to sequence of int
        Numbers of the chosen parts by their kind, "contact", "body" or "joint"; a missing kind means all of its parts.
    """

    solution: Solution
    times: Floats
    chosen: Mapping[str, Sequence[int]] = field(default_factory=dict)

    def numbers(self, kind: str) -> Sequence[int]:
        """Numbers of the chosen parts of a kind, "contact", "body" or "joint"."""
        return self.chosen[kind] if kind in self.chosen else range(len(_parts(self.solution.system, kind)))

    @property
    def replay(self) -> StateReplay:
        """Replay of the run, which sets its model to the state at any time."""
        return replay_of(self.solution)

    @functools.cached_property
    def y(self) -> Floats:
        """Integrated states at the times: q, u, energy accounts, inner states of laws; shape [n, n_y]."""
        return self.replay.states(self.times)

    @property
    def contacts(self) -> Integers:
        """Numbers of the chosen contacts."""
        return np.array(self.numbers("contact"), dtype=np.int64)

    @property
    def bodies(self) -> list[Body]:
        """The chosen bodies."""
        return [self.solution.system.bodies[number] for number in self.numbers("body")]

    def columns(self, of: str) -> Integers:
        """Indices of the columns that belong to the chosen bodies, in the array of all coordinates or all velocities.

        ``of`` is "n_q" for the coordinates q and "n_u" for the velocities u.
        """
        sizes = [getattr(body, of) for body in self.solution.system.bodies]
        first = np.cumsum([0, *sizes])
        return np.concatenate(
            [np.zeros(0, np.int64), *(np.arange(first[number], first[number + 1]) for number in self.numbers("body"))]
        )


def read_times(where: str, solution: Solution, times: ArrayLike | None) -> Floats:
    """Times [s] of shape [n], or [] for a single time; by default the times of the samples.

    Raises
    ------
    InvalidInput
        A time is not a number, or outside of the run.
    """
    if times is None:
        return solution.t
    try:
        found = np.array(times, dtype=float)
    except (TypeError, ValueError):
        found = np.full((0, 0), np.nan)
    if found.ndim > 1:
        raise InvalidInput(f"{where}: times", "must be a time or a row of times", times, "Give them in [s].")
    start = min(solution.track.time[0], solution.events.time.min(initial=np.inf))
    outside = found[~((found >= start) & (found <= solution.t_end))]
    if outside.size > 0:
        rule = f"must be within the run, which lasts from {float(start)!r} to {solution.t_end!r} s"
        raise InvalidInput(f"{where}: times", rule, float(outside.flat[0]), "Run longer, or ask for times of this run.")
    return found


def numbers_of(where: str, system: System, kinds: Sequence[str], of: Parts | None) -> dict[str, Sequence[int]]:
    """Numbers of the chosen parts of a system by their kind, "contact", "body" or "joint".

    If no part of a kind is chosen, all parts of that kind are returned.  An empty sequence chooses no parts at all.

    Parameters
    ----------
    where : str
        Name of the argument, for messages.
    system : System
        The system.
    kinds : sequence of str
        Kinds that may be chosen.
    of : Parts, optional
        The chosen parts; numbers are allowed if there is a single kind.

    Raises
    ------
    UnknownName
        No part of these kinds has this name.
    InvalidInput
        An object is not a part of the system, a number is out of range, or the kind of a number is not clear.
    """
    known = {kind: _parts(system, kind) for kind in kinds}
    chosen: dict[str, list[int]] = {kind: [] for kind in kinds}
    is_single = isinstance(of, str) or not isinstance(of, (Sequence, np.ndarray))
    several: Any = [] if of is None else [of] if is_single else of
    if len(several) and not kinds:
        raise InvalidInput(where, "must be left out", of, "No variable that was asked for belongs to a part.")
    for part in several:
        for kind, number in _found(where, system, known, part):
            chosen[kind].append(number)
    is_complete = of is None or len(several) > 0
    return {kind: chosen[kind] or range(is_complete * len(known[kind])) for kind in kinds}


def _found(where: str, system: System, known: Mapping[str, Sequence[object]], part: object) -> list[tuple[str, int]]:
    """Find the parts of a system to which ``part`` refers: an object, a name or a number that the user gave.

    Returns one pair (kind, number) at least, such as ("contact", 3).  There are several pairs if parts of different
    kinds have the name.  Raises the errors of :func:`numbers_of`.
    """
    several = " or ".join(known)
    if isinstance(part, (int, np.integer)) and not isinstance(part, bool):
        if len(known) != 1:
            rule = "must be a name or an object"
            raise InvalidInput(where, rule, part, f"Variables of {several} were asked for, so a number is not clear.")
        ((kind, parts),) = known.items()
        if part not in range(len(parts)):
            rule = f"must be below {len(parts)}, the number of {kind}s"
            raise InvalidInput(f"{where}: {kind}", rule, part, "Count from 0.")
        return [(kind, int(part))]
    if isinstance(part, str):
        names = {kind: getattr(system.names, _PLURALS[kind]) for kind in known}
        found = [(kind, own.index(part)) for kind, own in names.items() if part in own]
        if not found:
            raise UnknownName(f"{where}: {several}", part, [name for own in names.values() for name in own])
        return found
    # parts may be equal without being the same object
    same = [(kind, i) for kind, parts in known.items() for i, one in enumerate(parts) if one is part]
    if not same:
        remedy = "Take it, or its name, from solution.system."
        raise InvalidInput(where, f"needs a {several} of this system, its name or its number", part, remedy)
    return same


_PLURALS = {"contact": "contacts", "body": "bodies", "joint": "joints"}
"""For each kind of part, the attribute of a system that lists its parts.  The attribute of ``system.names`` with their
names is called the same."""


def _parts(system: System, kind: str) -> Sequence[object]:
    found: Sequence[object] = getattr(system, _PLURALS[kind])
    return found
