"""Names of the bodies, contacts, joints, loads and guards of a system: chosen by the user, or made from their kinds.

Made names are numbered from 1 if several parts have the same one: "ball 1", "ball 2", "plate", "plate - ball 2",
"plate - ball 2 (1)", "hinge base - arm".
"""

from __future__ import annotations

import functools
import itertools
import re
from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

from nonsmooth.errors import InvalidInput
from nonsmooth.plugins import registry

if TYPE_CHECKING:
    from nonsmooth.system.system import System

_BETWEEN = " - "
_RESERVED = (_BETWEEN, "(", ")")
"""Texts that join the parts of generated names. Chosen names must not contain them, to differ from generated names."""
_HUMP = re.compile(r"(?<=[a-z0-9])(?=[A-Z])")


@final
@dataclass(frozen=True)
class Names:
    """The names of all parts of a system, unique within each kind, in the order declared.

    Attributes
    ----------
    bodies, joints, loads, guards : tuple of str
        The names.
    labels : tuple of tuple
        Names of the contacts, in rows: name without number, number of the first contact of the row or 0, and number of
        contacts.
    """

    bodies: tuple[str, ...]
    labels: tuple[tuple[str, int, int], ...]
    joints: tuple[str, ...]
    loads: tuple[str, ...]
    guards: tuple[str, ...]

    @functools.cached_property
    def contacts(self) -> tuple[str, ...]:
        """Names of the contacts. They are made when they are used, because there may be hundreds of thousands."""
        return tuple(numbered(label, first, i) for label, first, count in self.labels for i in range(count))


def kind_word(component: object) -> str:
    """Kind of a component in words: its installed name, else the name of its class."""
    owner = type(component)
    word = registry.name_of(owner) or _HUMP.sub(" ", owner.__name__).lower()
    return " ".join(word.replace("_", " ").split())


def body_names(bodies: Sequence[object], chosen: Sequence[str]) -> tuple[str, ...]:
    """Names of bodies: the chosen name of each body, or a generated name if the chosen name is empty."""
    words = {kind: kind_word(body) for kind, body in {type(body): body for body in bodies}.items()}
    kinds = ["" if name else words[type(body)] for body, name in zip(bodies, chosen, strict=True)]
    totals, taken = Counter(kinds), {*chosen}
    # a single unnamed body of a kind is named by the kind, without a number. If the user gave this name to another
    # body, the unnamed body gets a number
    free = {
        kind: (word for word in itertools.chain([kind] * (total == 1), _numbered(kind)) if word not in taken)
        for kind, total in totals.items()
    }
    return tuple(name or next(free[kind]) for kind, name in zip(kinds, chosen, strict=True))


def _numbered(kind: str) -> Iterator[str]:
    return (f"{kind} {number}" for number in itertools.count(1))


def numbered(label: str, first: int, index: int) -> str:
    """Name of a part: its label, and behind it the number ``first`` + ``index``; only the label if ``first`` is 0."""
    return f"{label} ({first + index})" if first else label


def between(first: str, second: str, what: str = "") -> str:
    """Name of a contact, joint or load between two named bodies; ``what`` is its kind, empty for a contact."""
    return f"{what} {first}{_BETWEEN}{second}".strip()


@final
class Naming:
    """Gives the parts of one system their names.

    Parameters
    ----------
    bodies : sequence of Body
        The bodies.
    """

    def __init__(self, bodies: Sequence[object]) -> None:
        self._bodies = bodies
        self._chosen = [""] * len(bodies)
        self._made: tuple[str, ...] = ()
        self._given: dict[str, Counter[str]] = {}

    def __copy__(self) -> Naming:
        made = Naming(self._bodies)
        made._chosen, made._made, made._given = (
            [*self._chosen],
            self._made,
            {kind: counter.copy() for kind, counter in self._given.items()},
        )
        return made

    def choose(self, where: str, number: int, name: str) -> None:
        """Choose the name of a body, by its number.

        Raises
        ------
        InvalidInput
            If the name is malformed or taken, or contacts, joints, loads or guards have been named already.
        """
        check_name(where, name, [*self._chosen[:number], *self._chosen[number + 1 :]])
        if any(self._given.values()):
            remedy = "Name the bodies right after System([...])."
            raise InvalidInput(where, "must come before contacts, joints, loads and guards", name, remedy)
        self._chosen[number], self._made = name, ()

    @property
    def bodies(self) -> tuple[str, ...]:
        """The names of the bodies."""
        # the names are made at the first use: each contains the installed name of the body's class, and the search for
        # this name among the installed components takes a while
        self._made = self._made or body_names(self._bodies, self._chosen)
        return self._made

    def give(self, kind: str, chosen: str, made: Sequence[tuple[str, int]]) -> list[tuple[str, int]]:
        """Names for new parts of a kind: ``chosen``, or the names in ``made`` if it is empty. Equal names are numbered.

        Parameters
        ----------
        kind : str
            The kind, such as "contact".
        chosen : str
            Name that the user chose for all of the parts, or "".
        made : sequence of tuple
            Name made from the bodies, and number of parts that get it.

        Returns
        -------
        list of tuple
            For each entry of ``made`` the name, and the number behind the name of its first part, from which the others
            count on; 0 for a single part without a number.

        Raises
        ------
        InvalidInput
            If the chosen name is malformed or taken.
        """
        given = self._given.setdefault(kind, Counter())
        if chosen:
            check_name(f"System.{kind}: name", chosen, given)
        wanted = [(chosen or name, count) for name, count in made]
        totals = Counter[str]()
        for name, count in wanted:
            totals[name] += count
        found = []
        for name, count in wanted:
            is_single = totals[name] == 1 and not given[name]
            found.append((name, 0 if is_single else given[name] + 1))
            given[name] += count
        return found

    def give_one(self, kind: str, chosen: str, made: str) -> str:
        """Name of a single new part of a kind; arguments and errors as for :meth:`give`."""
        ((name, number),) = self.give(kind, chosen, [(made, 1)])
        return numbered(name, number, 0)

    def forget(self, kind: str) -> None:
        """Take back the names of all parts of a kind."""
        self._given.pop(kind, None)


def check_name(where: str, name: object, taken: Collection[str] = ()) -> None:
    """Check a name that a user chose.

    Raises
    ------
    InvalidInput
        If the name is no text or empty, has other blanks than single ones between words, is taken, or contains " - ",
        "(" or ")", which generated names contain.
    """
    if not isinstance(name, str) or not name or name != " ".join(name.split()) or not name.isprintable():
        raise InvalidInput(where, "must be a text of words with single blanks", name, 'For example "left hammer".')
    if any(part in name for part in _RESERVED):
        raise InvalidInput(
            where, f"must not have any of {', '.join(map(repr, _RESERVED))}", name, "Made names are put together so."
        )
    if name in taken:
        raise InvalidInput(where, "must be one that nothing of its kind has yet", name, "Choose another.")


@final
@dataclass(frozen=True)
class Labels:
    """Names of the coordinates and velocities of a system, in its order.

    Attributes
    ----------
    coordinates, velocities : tuple of tuple of str
        Name of the body, label such as "ball 2 x", and unit.
    """

    coordinates: tuple[tuple[str, str, str], ...]
    velocities: tuple[tuple[str, str, str], ...]


def labels(system: System) -> Labels:
    """Labels of the coordinates and velocities of a system, such as "ball 2 x" [m]."""
    pairs = list(zip(system.bodies, system.names.bodies, strict=True))
    return Labels(
        tuple((label, f"{label} {name}", unit) for body, label in pairs for name, unit in body.q_labels),
        tuple((label, f"{label} {name}", unit) for body, label in pairs for name, unit in body.u_labels),
    )
