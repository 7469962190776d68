"""Bodies with an own step (multirate): they are not integrated with the rest of the system.

Such a body sticks to a body at rest by a single contact. It has taken a step whose end is known
(:mod:`nonsmooth.engine.flow.own_steps`). Until that end it moves along the interpolant of the step, whatever happens
elsewhere, as long as no other body touches it.
"""

from __future__ import annotations

from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.native.kernel import Workspace, kernel


@kernel("b1(ws, i8)")
def has_own_step(ws: Workspace, c: int) -> bool:
    """True if contact ``c`` is closed and one of its bodies has an own step (multirate).

    Such a body moves along the interpolant of a step of its own. It has no other closed contact, so ``c`` needs no part
    in the steps and events of the rest.
    """
    contact = ws.contacts[c]
    if contact.mode == Mode.OPEN:
        return False
    return ws.bodies[contact.body_a].has_own_step or ws.bodies[contact.body_b].has_own_step


@kernel("i8(ws, i8)")
def end_own_steps_of(ws: Workspace, c: int) -> int:
    """End the own steps (multirate) of the two bodies of contact ``c`` at the present time. Number that ended, 0 to 2.

    The bodies are then integrated with the rest of the system.
    """
    contact = ws.contacts[c]
    body_a, body_b = ws.bodies[contact.body_a], ws.bodies[contact.body_b]
    n_ended = body_a.has_own_step + body_b.has_own_step
    body_a.has_own_step = body_b.has_own_step = False
    return int(n_ended)
