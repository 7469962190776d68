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
class ArticulationLayout:
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


def articulations(system: System) -> list[ArticulationLayout]:
    """The articulations (groups of bodies that joints tie together) of a system, in the order of its bodies.

    Each body belongs to one. They are the shortest ranges of consecutive bodies such that no joint ties movable bodies
    of two ranges. A body between two tied ones belongs to their range even without a joint. That costs time and does
    not change the motion. Each joint must have a movable body, one with velocities (``n_u`` > 0). A driven body ties no
    others: its motion is given.
    """
    bodies = system.bodies
    # of each body the last one that a joint ties to it
    last = list(range(len(bodies)))
    for tie in system.joints:
        numbers = [i for i, body in enumerate(bodies) if (body is tie.first or body is tie.second) and body.n_u > 0]
        last[numbers[0]] = max(last[numbers[0]], numbers[-1])
    found: list[ArticulationLayout] = []
    first = 0
    while first < len(bodies):
        end = number = first
        # the range grows by the bodies that are tied to those in it
        while number <= end:
            end = max(end, last[number])
            number += 1
        members = bodies[first : end + 1]
        # a driven body may belong to another range, so a joint belongs to the range of its movable bodies
        movable = [body for body in members if body.n_u > 0]
        joints = tuple(t for t in system.joints if any(body is t.first or body is t.second for body in movable))
        found.append(ArticulationLayout(first, members, joints))
        first = end + 1
    return found


def joints_in_order(system: System) -> list[Tie]:
    """The joints of a system in the order in which the memory has them: articulation by articulation."""
    return [joint for articulation in articulations(system) for joint in articulation.joints]
