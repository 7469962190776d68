"""Articulations: groups of bodies that joints tie together.

The constraint forces of a group are found together, with matrices over the velocities of the group. The velocities of a
group are a range of those of the system, so a group consists of bodies in a row.
"""

from __future__ import annotations

from dataclasses import dataclass

from nonsmooth.interfaces import Body
from nonsmooth.system.contact import Tie
from nonsmooth.system.system import System


@dataclass(frozen=True)
class Articulation:
    """Bodies that joints tie together, and these joints.

    Attributes
    ----------
    first : int
        Number of the first body in the system; the others follow.
    bodies : tuple of Body
        The bodies.
    joints : tuple of Tie
        The joints.
    """

    first: int
    bodies: tuple[Body, ...]
    joints: tuple[Tie, ...]


def articulations(system: System) -> list[Articulation]:
    """Split the bodies into the shortest runs of consecutive bodies such that no joint ties movable bodies of two runs.

    A run of bodies is an articulation: its velocities are consecutive, and joints couple them. A body between two of a
    run belongs to it even without a joint. That costs time and does not change the motion. Each joint must have a
    movable body.
    """
    bodies = system.bodies
    last = list(range(len(bodies)))
    for tie in system.joints:
        numbers = [i for i, body in enumerate(bodies) if (body is tie.first or body is tie.second) and body.n_u > 0]
        last[numbers[0]] = max(last[numbers[0]], numbers[-1])
    found: list[Articulation] = []
    first = 0
    while first < len(bodies):
        end = number = first
        while number <= end:
            end = max(end, last[number])
            number += 1
        members = bodies[first : end + 1]
        movable = [body for body in members if body.n_u > 0]
        joints = tuple(t for t in system.joints if any(body is t.first or body is t.second for body in movable))
        found.append(Articulation(first, members, joints))
        first = end + 1
    return found
