"""Courses: bodies that stick to one at rest by one contact go on past events that are none of theirs.

Such a body has had a step of its own (:mod:`nonsmooth.engine.flow.courses`), whose end is known; until then it is where
the interpolant of that step says, as long as nothing else touches it.
"""

from __future__ import annotations

from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel("b1(ws, i8)")
def has_own_step(ws: Workspace, c: int) -> bool:
    """True if contact ``c`` is the one closed contact of a body that takes a step of its own (multirate)."""
    contact = ws.contacts[c]
    if contact.mode == Mode.OPEN:
        return False
    return ws.bodies[contact.body_a].has_own_step or ws.bodies[contact.body_b].has_own_step


@kernel("i8(ws, i8)")
def end_courses_of(ws: Workspace, c: int) -> int:
    """End the courses of the bodies of contact ``c``, which stay where they are; return how many."""
    contact = ws.contacts[c]
    one, two = ws.bodies[contact.body_a], ws.bodies[contact.body_b]
    ended = one.has_own_step + two.has_own_step
    one.has_own_step = two.has_own_step = False
    return int(ended)
