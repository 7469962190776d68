"""Which pairs of bodies a system says something of: contacts, joints, and that they are to be left alone."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import final

from nonsmooth.interfaces import Body
from nonsmooth.system.system import System

Pairs = frozenset[tuple[int, int]]
"""Pairs of numbers of bodies, the lower one first."""


@final
@dataclass(frozen=True)
class Ties:
    """What is said of pairs of bodies.

    Attributes
    ----------
    declared, joined, excluded : Pairs
        Pairs with contacts, tied by a joint, and said not to touch.
    mechanisms : tuple of frozenset of int
        Bodies that joints tie to each other, over others as well; driven ones stand in each that they are tied to.
    """

    declared: Pairs
    joined: Pairs
    excluded: Pairs
    mechanisms: tuple[frozenset[int], ...]

    @classmethod
    def of(cls, system: System) -> Ties:
        """Return what a system says."""
        number = {id(body): i for i, body in enumerate(system.bodies)}

        def pairs(bodies: Iterable[tuple[Body, Body]]) -> Pairs:
            numbers = [(number[id(one)], number[id(two)]) for one, two in bodies]
            return frozenset([(i, j) if i < j else (j, i) for i, j in numbers])

        joined = pairs((tie.first, tie.second) for tie in system.joints)
        return cls(
            pairs((said.first, said.second) for said in system.declarations),
            joined,
            pairs(system.excluded),
            _mechanisms(system, joined),
        )

    def same_mechanism(self, i: int, j: int) -> bool:
        """Tell whether joints tie two bodies, be it over others."""
        return any(i in group and j in group for group in self.mechanisms)


def _mechanisms(system: System, joined: Pairs) -> tuple[frozenset[int], ...]:
    groups: list[set[int]] = []
    for pair in joined:
        movable = {i for i in pair if system.bodies[i].n_u > 0}
        # a driven body, such as the ground, does not tie to each other what is tied to it
        met = [group for group in groups if group & movable]
        groups = [group for group in groups if not group & movable]
        groups.append(set().union(pair, *met))
    return tuple(map(frozenset, groups))
