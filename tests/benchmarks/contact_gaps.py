"""Least gap of the contacts of two shapes at any place, to compare it with their distance."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import final

import numpy as np

from nonsmooth.binding.source import described, name_of
from nonsmooth.engine.memory.blocks import CANDIDATE, FRAME, GEOMETRY, PAST_END
from nonsmooth.errors import PluginError
from nonsmooth.interfaces import CandidateSearch, FeaturePair, Shape
from nonsmooth.interfaces.distance_backend import Place
from nonsmooth.interfaces.solid import Vector
from nonsmooth.queries.result import DistanceResult
from nonsmooth.system.pairing import installed_pair
from tests.bodies.every_pair import every_pair
from tests.contact_calls import candidate_caller, pair_caller

_HALVINGS = 40
"""Largest number of halvings of the distance within which near features are searched for.  The distance is halved as
long as the search finds more pairs of features than the kinematics has contacts."""


class _Given:
    """Contacts with fixed features."""

    def __init__(self, contacts: Sequence[FeaturePair]) -> None:
        self._calls = [pair_caller(one.evaluator, one.values, name_of(one.evaluator)) for one in contacts]

    def blocks(self, a: Vector, b: Vector, reach: float) -> Iterator[tuple[Vector, float]]:
        """Yield the geometry block of each contact, and the distance up to which all gaps are known [m].

        This distance is infinite, because every pair of features has its own contact.
        """
        for call in self._calls:
            out = np.zeros(GEOMETRY)
            call(a, b, out)
            yield out, np.inf


class _Searched:
    """Contacts whose features a search finds at each pose."""

    def __init__(self, contacts: Sequence[FeaturePair], search: CandidateSearch) -> None:
        one, name = contacts[0], name_of(contacts[0].evaluator)
        self._name, self._function = name, search.function
        self._find = pair_caller(search.function, search.values, name)
        self._call = candidate_caller(one.evaluator, one.values, name)
        self._most = len(contacts)

    def blocks(self, a: Vector, b: Vector, reach: float) -> Iterator[tuple[Vector, float]]:
        """Yield the geometry block of each pair of near features, and the distance up to which all gaps are known [m].

        This distance is ``reach``.  It is halved until the number of pairs within it is at most the number of contacts.
        """
        found, n = np.zeros(1 + CANDIDATE * (self._most + 1)), 0
        for _ in range(_HALVINGS):
            found[0] = reach
            self._find(a, b, found)
            if not found[0] >= 0.0:
                raise PluginError(f"{self._name}: {described(self._function)}, gives {found[0]:g} features.")
            n = int(found[0])
            if n <= self._most:
                break
            reach *= 0.5
        for candidate in found[1 : 1 + CANDIDATE * min(n, self._most)].reshape(-1, CANDIDATE):
            out = np.zeros(GEOMETRY)
            self._call(a, b, out, np.append(candidate, 2.0 * reach))
            yield out, reach


@final
class Contacts:
    """All contacts of two shapes, by the kinematics that is installed for them, compiled.

    Parameters
    ----------
    first, second : Shape
        The shapes, in any order.
    of_all : bool
        Whether every pair of features is a contact of its own, without a search.

    Raises
    ------
    LookupError
        If no kinematics is installed for the shapes.
    InvalidInput
        If the kinematics refuses the shapes, for example meshes with too many features.
    PluginError
        In a query, if the search of the kinematics for features fails.
    """

    def __init__(self, first: Shape, second: Shape, of_all: bool = False) -> None:
        found = installed_pair(first, second)
        if found is None:
            raise LookupError(f"{type(first).__name__}-{type(second).__name__}")
        kinematics, self._in_order = found
        contacts = kinematics.between(*((first, second) if self._in_order else (second, first)))
        contacts = every_pair(contacts) if of_all else contacts
        search = contacts[0].candidates
        self._contacts = _Given(contacts) if search is None else _Searched(contacts, search)
        self._extent = first.extent + second.extent

    def least(self, one: Place, two: Place) -> DistanceResult | None:
        """Least gap of the features that face each other, None if no features do.

        The bounds ``lower`` and ``upper`` of the result equal the gap, because kinematics gives no bounds of its error.
        """
        a, b = np.zeros(FRAME), np.zeros(FRAME)
        for block, (position, axes) in zip((a, b), (one, two) if self._in_order else (two, one), strict=True):
            block[:3], block[3:12] = position, axes.ravel()
        best: Vector | None = None
        reach = float(np.linalg.norm(a[:3] - b[:3])) + self._extent
        for out, known in self._contacts.blocks(a, b, reach):
            # a gap of NaN fails both comparisons, so its contact is skipped
            if out[PAST_END] <= 0.0 and (out[0] < best[0] if best is not None else out[0] <= known):
                best = out
        if best is None:
            return None
        gap = float(best[0])
        found = DistanceResult(gap, gap, gap, best[7:10], best[10:13], best[1:4], "contacts")
        return found if self._in_order else found.exchanged()
