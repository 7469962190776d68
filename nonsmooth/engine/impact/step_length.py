"""Lengths of the steps of an impact, in pseudo-time.

Steps follow the error of the last one, and its trend, as in the motion. Three places need more:

* The first step. No error is known, and a contact without deformation has no force.
* The end of an expansion. A force law such as x^1.5 is not smooth at zero: steps shrink with the deformation.
* An implicit step in which slips settle. Its error grows with a lower power of its length.
"""

from __future__ import annotations

import math

from nonsmooth.engine.impact.state import state_at, state_of
from nonsmooth.engine.memory.modes import NO_CONTACT, Phase
from nonsmooth.engine.native.kernel import Workspace, kernel
from nonsmooth.engine.numerics.runge_kutta import SAFETY, SHRINK, step_factor

_FIRST_POWER = 0.25
"""Exponent: the first step, relative to the duration of the shortest compression, is the tolerance to this power.

Contacts without deformation have no force yet. So their forces are compared after a time of this length.
"""
_FAR = 4.0
"""First step of a lone contact, relative to the impulse that stops it. It is past all events of the contact."""
_LARGEST_LOSS = 0.7
"""Largest part of its deformation that a contact loses in one step of its expansion [1]."""
_LAST = 2.0
"""Factor c: steps of an expansion shrink down to the deformation c tolerance^p, relative to a full compression."""
_LAST_POWER = 0.4
"""Exponent p: steps of an expansion shrink down to the deformation c tolerance^p, relative to a full compression."""
_SETTLING_POWER = -0.4
"""Inverse of the power 2.5 with which the error grows of an implicit step in which slips settle. Its stages are of
second order there."""
_NOT_FINITE = 0.1
"""Factor by which a step is shortened whose error is not finite."""


@kernel("f8(ws, f8)")
def first_step(ws: Workspace, shortest: float) -> float:
    """First step of an impact, in pseudo-time. Its ``shortest`` compression takes that pseudo-time.

    The step of a single contact passes all of its events, because it is shortened to the next one. Other steps begin
    small, as no error is known yet.
    """
    return shortest * (_FAR if len(ws.actives) == 1 else float(ws.tolerance.impact) ** _FIRST_POWER)


@kernel("f8(ws, f8, f8)")
def step_after_switch(ws: Workspace, h: float, shortest: float) -> float:
    """Length of the step after one of ``h`` that ended at a switch of phases: ``h``, but not less than the first step.

    A lone contact has its own length.
    """
    if ws.impact.lone_contact != NO_CONTACT:
        return lone_step(ws)
    return float(max(h, shortest * ws.tolerance.impact**_FIRST_POWER))


@kernel("f8(ws)")
def lone_step(ws: Workspace) -> float:
    """Step of the lone contact, in its impulse [N s], before it is shortened to the next event."""
    return _FAR * ws.actives[ws.impact.lone_contact].impulse_scale


@kernel("f8(ws, f8)")
def graded_step(ws: Workspace, h: float) -> float:
    """Length of a step, at most ``h``, in which no expanding contact loses more than a part of its deformation.

    So steps shrink geometrically towards the end of an expansion, down to a small deformation.
    """
    for active in ws.actives:
        deformation = state_of(ws, active).deformation
        rate = state_at(ws, ws.impact.slopes.start, active).deformation
        loses_much = active.phase == Phase.EXPANSION and h * rate < -_LARGEST_LOSS * deformation
        if loses_much and deformation > _LAST * ws.tolerance.impact**_LAST_POWER * active.deformation_scale:
            h = -_LARGEST_LOSS * deformation / rate
    return h


@kernel("f8(ws, f8)")
def rejection_factor(ws: Workspace, error: float) -> float:
    """Factor by which a rejected step of a relative ``error`` [1] must be shorter."""
    if not error < math.inf:
        return _NOT_FINITE
    return max(SHRINK, SAFETY * error**_SETTLING_POWER) if ws.impact.is_step_implicit else float(step_factor(error))
