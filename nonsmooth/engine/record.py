"""Writing samples and events to the buffers that Python empties between calls."""

from __future__ import annotations

import math

from nonsmooth.engine.kernel import Floats, Integers, Scalars, kernel
from nonsmooth.engine.modes import OPEN, SLIDE
from nonsmooth.engine.runge_kutta import dense_state

EVENT_HEAD = 5
"""Floats at the head of an event: time, driven work, restitution loss, friction loss, closing loss."""
CODE_HEAD = 4
"""Integers at the head of an event: cause, contact, phases, whether cut short; then one code per contact."""


@kernel("i8(S, F, I, i8)")
def code(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return the bits a + 2 b + 4 c of Eq. (29) of contact ``c`` in its present mode."""
    mode = k[S.mode + c]
    if mode == OPEN:
        return 0
    return 5 if mode == SLIDE else 1


@kernel("i8(S, F, I, i8)")
def impact_code(S: Scalars, w: Floats, k: Integers, c: int) -> int:
    """Return the bits of contact ``c`` at the start of an impact, from its rates."""
    if k[S.touching + c] == 0:
        return 0
    bits = 1
    if w[S.rate + 3 * c] < -S.velocity_tolerance:
        bits += 2
    v1, v2 = w[S.rate + 3 * c + 1], w[S.rate + 3 * c + 2]
    if math.sqrt(v1 * v1 + v2 * v2) > S.velocity_tolerance:
        bits += 4
    return bits


@kernel()
def remember(S: Scalars, w: Floats, k: Integers) -> None:
    """Keep modes and velocities as they are before an event, and clear its account."""
    for c in range(S.n_contacts):
        k[S.code_before + c] = code(S, w, k, c)
        k[S.code_during + c] = k[S.code_before + c]
        for r in range(3):
            w[S.event_impulse + 3 * c + r] = 0.0
    for i in range(S.n_u):
        w[S.u_before + i] = w[S.y + S.n_q + i]
    for i in range(1, EVENT_HEAD):
        w[S.event_head + i] = 0.0


@kernel("void(S, F, I, i8, i8, i8)")
def record_event(S: Scalars, w: Floats, k: Integers, cause: int, contact: int, phases: int) -> None:
    """Append an event with what was remembered before it and the modes after it."""
    S.recorded += 1
    if S.n_events >= S.event_capacity:
        return
    n = S.n_contacts
    row = S.events + S.n_events * S.event_width
    w[S.event_head] = S.t
    for i in range(EVENT_HEAD):
        w[row + i] = w[S.event_head + i]
    row += EVENT_HEAD
    for i in range(3 * n):
        w[row + i] = w[S.event_impulse + i]
    row += 3 * n
    for i in range(S.n_q):
        w[row + i] = w[S.y + i]
    row += S.n_q
    for i in range(S.n_u):
        w[row + i] = w[S.u_before + i]
        w[row + S.n_u + i] = w[S.y + S.n_q + i]
    codes = S.event_codes + S.n_events * (CODE_HEAD + n)
    k[codes], k[codes + 1], k[codes + 2] = cause, contact, phases
    k[codes + 3] = S.truncated if phases > 0 else 0
    for c in range(n):
        k[codes + CODE_HEAD + c] = k[S.code_before + c] + 8 * k[S.code_during + c] + 64 * code(S, w, k, c)
    S.n_events += 1


@kernel()
def amend_last(S: Scalars, w: Floats, k: Integers) -> None:
    """Write the modes that the instant ended in, and its final velocities, into its last event."""
    if S.n_events == 0:
        return
    n = S.n_contacts
    row = S.events + (S.n_events - 1) * S.event_width + EVENT_HEAD + 3 * n + S.n_q + S.n_u
    for i in range(S.n_u):
        w[row + i] = w[S.y + S.n_q + i]
    codes = S.event_codes + (S.n_events - 1) * (CODE_HEAD + n) + CODE_HEAD
    for c in range(n):
        k[codes + c] = k[codes + c] % 64 + 64 * code(S, w, k, c)


@kernel("void(S, F, I, f8)")
def record_samples(S: Scalars, w: Floats, k: Integers, h: float) -> None:
    """Append the samples that fall into the part ``h`` of the step from ``t`` whose slopes are at hand."""
    width = S.n_y + 1
    while S.next_sample <= S.t + h and S.n_samples < S.sample_capacity:
        row = S.samples + S.n_samples * width
        w[row] = S.next_sample
        theta = (S.next_sample - S.t) / S.h
        dense_state(S, w, S.y, S.slopes, S.n_y, S.h, min(1.0, max(0.0, theta)), row + 1)
        S.n_samples += 1
        S.sample_index += 1
        S.next_sample = S.sample_index * S.sample_interval
