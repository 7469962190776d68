"""Guards: what ends a mode, and when.

Every contact has two guards, positive while its mode is valid:

* open: the gap; the second is not used.
* closed: the normal force; and, sticking, the distance to the static bound, sliding, the slip
  velocity along its direction at the start of the step.

An event lies in the half-open interval t0 < t* <= t1 of a step.  A guard that starts from zero (a gap
just after an impact, a slip just begun) is divided by the elapsed time, so that its zero at the
start does not fire while the next one does.  Guards are sampled inside every step; between two samples
at which a gap first falls and then rises, its minimum is located, so that no dip is missed.
"""

from __future__ import annotations

from nonsmooth.engine.flow import right_hand_side, try_step
from nonsmooth.engine.forces import evaluate_margins
from nonsmooth.engine.kernel import kernel, room
from nonsmooth.engine.kinematics import evaluate_bodies, evaluate_geometry, evaluate_rates
from nonsmooth.engine.modes import OPEN, STICK
from nonsmooth.engine.runge_kutta import dense_state
from nonsmooth.model.layout import GEOMETRY

_SAMPLES = 4
_WRONG = -1e-9
"""A guard that is not armed fires below this all the same."""


@room("void(S, F, I, f8, i8, f8, i8)")
def evaluate_guards(S, w, k, t, y, elapsed, forces):
    """Write the guards at ``t`` and ``y``; those of closed contacts only if ``forces`` is 1."""
    if forces == 1:
        right_hand_side(S, w, k, t, y)
        evaluate_margins(S, w, k)
        for a in range(S.n_active):
            c = k[S.active + a]
            w[S.guard + 2 * c] = w[S.f + 3 * a]
            if k[S.mode + c] == STICK:
                w[S.guard + 2 * c + 1] = w[S.margin + a]
            else:
                w[S.guard + 2 * c + 1] = (
                    w[S.rate + 3 * c + 1] * w[S.direction + 2 * c]
                    + w[S.rate + 3 * c + 2] * w[S.direction + 2 * c + 1]
                )
    else:
        evaluate_bodies(S, w, k, t, y)
    for c in range(S.n_contacts):
        if k[S.mode + c] == OPEN:
            evaluate_geometry(S, w, k, c)
            evaluate_rates(S, w, k, c)
            w[S.guard + 2 * c] = w[S.geometry + GEOMETRY * c]
            w[S.guard + 2 * c + 1] = 1.0
            w[S.gap_rate + c] = w[S.rate + 3 * c]
    if elapsed > 0.0:
        for i in range(2 * S.n_contacts):
            if k[S.guard_deflated + i] == 1:
                w[S.guard + i] /= elapsed


@kernel()
def arm_guards(S, w, k):
    """Evaluate the guards at the start of a step; arm the positive ones, deflate those that start from zero."""
    for i in range(2 * S.n_contacts):
        k[S.guard_deflated + i] = 0
    evaluate_guards(S, w, k, S.t, S.y, 0.0, 1)
    for c in range(S.n_contacts):
        first = 2 * c
        if k[S.mode + c] == OPEN:
            if w[S.guard + first] <= S.gap_tolerance:
                k[S.guard_deflated + first] = 1
                w[S.guard + first] = w[S.gap_rate + c]
        elif k[S.mode + c] != STICK and w[S.guard + first + 1] <= S.velocity_tolerance:
            k[S.guard_deflated + first + 1] = 1
            w[S.guard + first + 1] = _slip_acceleration(S, w, k, c)
    for c in range(S.n_contacts):
        w[S.gap_rate_first + c] = w[S.gap_rate + c]
    for i in range(2 * S.n_contacts):
        w[S.guard_first + i] = w[S.guard + i]
        k[S.guard_armed + i] = 1 if w[S.guard + i] > 0.0 else 0


@kernel("f8(S, F, I, i8)")
def _slip_acceleration(S, w, k, c):
    """Return the acceleration of the slip of contact ``c`` along its direction, forces being known."""
    total = 0.0
    width = 3 * S.n_active
    for a in range(S.n_active):
        if k[S.active + a] == c:
            for r in range(1, 3):
                line = 3 * a + r
                value = w[S.b + line]
                for j in range(width):
                    value += w[S.delassus + line * width + j] * w[S.f + j]
                total += value * w[S.direction + 2 * c + r - 1]
    return total


@kernel("i8(S, F, I, i8, i8)")
def _first_fired(S, w, k, forces, but):
    """Return the first guard that has fired, other than ``but``, or -1."""
    for i in range(2 * S.n_contacts):
        if forces == 0 and k[S.mode + i // 2] != OPEN:
            continue
        value = w[S.guard + i]
        if i != but and ((value < 0.0 and k[S.guard_armed + i] == 1) or value < _WRONG):
            return i
    return -1


@kernel("void(S, F, I, f8, f8, i8)")
def _guards_within(S, w, k, h, theta, forces):
    dense_state(S, w, S.y, S.slopes, S.n_y, h, theta, S.y_stage)
    evaluate_guards(S, w, k, S.t + theta * h, S.y_stage, theta * h, forces)


@kernel("f8(S, F, I, f8, f8, f8, i8)")
def _hidden_minimum(S, w, k, h, low, high, c):
    """Return the fraction of the step between ``low`` and ``high`` where the gap of ``c`` is least."""
    for _iteration in range(50):
        middle = 0.5 * (low + high)
        _guards_within(S, w, k, h, middle, 0)
        if w[S.guard + 2 * c] < 0.0:
            return middle
        if w[S.gap_rate + c] < 0.0:
            low = middle
        else:
            high = middle
        if high - low < 1e-6:
            break
    return high


@kernel("f8(S, F, I, f8)")
def first_crossing(S, w, k, h):
    """Return a fraction of the step by which some guard has fired, or 0 if none does."""
    n = S.n_contacts
    closed = 0
    for c in range(n):
        w[S.gap_rate_last + c] = w[S.gap_rate_first + c]
        if k[S.mode + c] != OPEN:
            closed = 1
    low = 0.0
    for sample in range(1, _SAMPLES + 1):
        high = sample / _SAMPLES
        forces = 1 if closed == 1 and sample % 2 == 0 else 0
        if sample == _SAMPLES:
            evaluate_guards(S, w, k, S.t + h, S.y_new, h, forces)
        else:
            _guards_within(S, w, k, h, high, forces)
        if _first_fired(S, w, k, forces, -1) >= 0:
            return high
        for i in range(2 * n):
            if w[S.guard + i] > 0.0 and (forces == 1 or k[S.mode + i // 2] == OPEN):
                k[S.guard_armed + i] = 1
        for c in range(n):
            if k[S.mode + c] == OPEN and w[S.gap_rate_last + c] < 0.0 and w[S.gap_rate + c] > 0.0:
                rate = w[S.gap_rate + c]
                theta = _hidden_minimum(S, w, k, h, low, high, c)
                if w[S.guard + 2 * c] < 0.0:
                    return theta
                w[S.gap_rate + c] = rate
        for c in range(n):
            w[S.gap_rate_last + c] = w[S.gap_rate + c]
        low = high
    return 0.0


@kernel("f8(S, F, I, f8, f8, i8)")
def _guard_at(S, w, k, h, theta, i):
    _guards_within(S, w, k, h, theta, 0 if k[S.mode + i // 2] == OPEN else 1)
    return w[S.guard + i]


@kernel("f8(S, F, I, f8, f8, i8)")
def _root(S, w, k, h, high, i):
    """Return the fraction of the step at which guard ``i`` vanishes, by Illinois on the interpolant."""
    low, g_low = 0.0, w[S.guard_first + i]
    g_high = _guard_at(S, w, k, h, high, i)
    if g_low <= 0.0:
        # it was armed inside the step: look for where it was positive
        low = 0.5 * high
        g_low = _guard_at(S, w, k, h, low, i)
        while g_low <= 0.0 and low > 1e-3 * high:
            low *= 0.5
            g_low = _guard_at(S, w, k, h, low, i)
        if g_low <= 0.0:
            return low
    for _iteration in range(80):
        theta = high - g_high * (high - low) / (g_high - g_low)
        g = _guard_at(S, w, k, h, theta, i)
        if g == 0.0 or (high - low) * h <= 0.01 * S.time_tolerance:
            return theta
        if g < 0.0:
            if g_high - g == 0.0 or abs(theta - high) * h <= 0.01 * S.time_tolerance:
                return theta
            high, g_high = theta, g
            g_low *= 0.5
        else:
            if abs(theta - low) * h <= 0.01 * S.time_tolerance:
                return theta
            low, g_low = theta, g
            g_high *= 0.5
    return high


@kernel("f8(S, F, I, f8, f8)")
def locate(S, w, k, h, high):
    """Step to the first event before the fraction ``high`` of the step; return the step, guard in ``trigger``.

    The root on the interpolant is corrected on the step itself, whose order is higher.
    """
    closed = 0
    for c in range(S.n_contacts):
        if k[S.mode + c] != OPEN:
            closed = 1
    _guards_within(S, w, k, h, high, closed)
    first = _first_fired(S, w, k, closed, -1)
    if first < 0:
        _guards_within(S, w, k, h, high, 0)
        first = max(0, _first_fired(S, w, k, 0, -1))
    theta = high
    while first >= 0:
        S.trigger = first
        theta = _root(S, w, k, h, theta, first)
        _guards_within(S, w, k, h, theta, closed)
        first = _first_fired(S, w, k, closed, S.trigger)
    i = S.trigger
    g = _guard_at(S, w, k, h, theta, i)
    rate = (g - _guard_at(S, w, k, h, 0.99 * theta, i)) / (0.01 * theta * h)
    step = theta * h
    for _iteration in range(4):
        try_step(S, w, k, step)
        evaluate_guards(S, w, k, S.t + step, S.y_new, step, 0 if k[S.mode + i // 2] == OPEN else 1)
        if not rate < 0.0:
            break
        correction = -w[S.guard + i] / rate
        if abs(correction) <= 0.1 * S.time_tolerance:
            break
        step = min(1.2 * theta * h, max(0.8 * theta * h, step + correction))
    return step
