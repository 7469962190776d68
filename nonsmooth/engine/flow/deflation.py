"""Deflation: the root of a guard at the start of a step is divided out, so that the next one is the first.

An event lies in the half-open interval t0 < t* <= t1 of a step. A guard that is zero at t0, such as the gap
just after an impact, would fire at once. Its known root is divided out: the guard is replaced by its growth since t0,
divided by the elapsed time. The next root is then the first one. The growth counts from ``guard.base``; of a deflated
guard ``guard.initial`` is the growth rate at t0, of any other the value at t0.
"""

from __future__ import annotations

from nonsmooth.engine.flow.guard_numbers import first_end_guard, first_user_guard, is_of_open_contact
from nonsmooth.engine.native.kernel import GuardRecord, Workspace, kernel
from nonsmooth.engine.numerics.tolerances import NEGLIGIBLE


@kernel("f8(ws, i8, f8, f8)")
def deflated(ws: Workspace, i: int, value: float, elapsed: float) -> float:
    """Value whose root is searched for: ``value`` of guard ``i``, or its mean growth rate if the guard is deflated.

    A deflated guard starts about zero. Its growth over ``elapsed`` [s] since the start of the step, divided by that
    time, has all its other roots. A gap that separates and is still within round-off has its rate at the start instead.
    """
    guard = ws.guards[i]
    if not guard.is_deflated:
        return value
    # of a deflated guard, initial is the growth rate at the start
    rate = guard.initial
    separates = i < first_user_guard(ws) and is_of_open_contact(ws, i) and rate > ws.tolerance.velocity
    if separates and rate * elapsed <= NEGLIGIBLE * ws.tolerance.gap:
        return rate
    return (value - guard.base) / elapsed


@kernel("void(ws, f8)")
def deflate(ws: Workspace, elapsed: float) -> None:
    """Replace the values of deflated guards by their mean growth rates, ``elapsed`` [s] after the start of the step.

    A guard is deflated if it starts about zero. End guards of features, which follow those of the user, never are.
    """
    for i in range(first_end_guard(ws)):
        guard = ws.guards[i]
        if guard.is_deflated:
            guard.value = deflated(ws, i, guard.value, elapsed)


@kernel("void(GuardRecord, f8, f8)")
def start_from_zero(guard: GuardRecord, slack: float, rate: float) -> None:
    """Deflate a guard that starts about zero: its growth takes the place of its value, so that this root is left out.

    The growth counts from zero, or from the value of the guard if that is negative, lowered by ``slack`` in its unit.
    ``rate`` is the growth per second at the start, 0 if not known.
    """
    guard.is_deflated = True
    guard.base = min(0.0, guard.base) - slack
    guard.initial = rate
