"""A large multiple impact, of which only the contacts about a travelling wave are looked at.

Most contacts of a long chain are idle at any moment of its impact.  A window holds those that act and their
neighbours; where the wave comes to its rim the impulses so far are given to the bodies, and the next window is drawn
about the contacts that act then.  The phases, deformations and energies go on as they are: no step is different.
"""

from __future__ import annotations

from nonsmooth.engine.bodies.kinematics import row
from nonsmooth.engine.delassus.blocks import link_active
from nonsmooth.engine.delassus.delassus import add_response, assemble_delassus
from nonsmooth.engine.impact.end import account
from nonsmooth.engine.impact.problem import (
    ENDLESS,
    INVALID,
    MOVED,
    PROBE,
    first_step,
    run_impact,
    start_impact,
)
from nonsmooth.engine.impact.rates import DEFORMATION, ENERGY, IDLE, IMPULSE, LOST, NOISE, RUBBED, STRIDE
from nonsmooth.engine.impact.scales import scale_impact
from nonsmooth.engine.memory.layout import TOTALS
from nonsmooth.engine.native.kernel import Floats, Integers, Scalars, kernel, room

LARGE = 16
"""Impacts with more contacts than this are looked at through a window."""
_LAYERS = 4
"""How many neighbours deep a window reaches beyond the contacts that act."""
_FAINT = 30.0
"""Rates and deformations of the error of so many steps are not told from rest behind the wave."""
_MOST_WINDOWS = 1000000
_SIDES = 2
"""Entries of a contact in the chains of its linkages."""
_IMPULSE, _STORED, _RETURNED, _RUBBED, _DEFORMATION, _ENERGY, _LOST = 0, 3, 4, 5, 6, 7, 8
"""Where these stand among what a contact takes from one window to the next."""


@kernel("void(S, F, I)")
def _gather_colliding(S: Scalars, w: Floats, k: Integers) -> None:
    """Keep the active contacts as those of the impact, with nothing done yet, and hang them on their linkages."""
    S.n_colliding = S.n_active
    for linkage in range(S.n_linkages):
        k[S.linkage_head + linkage] = -1
    for i in range(S.n_u):
        w[S.u_impact + i] = w[S.own + i]
    for i in range(S.n_colliding):
        c = k[S.active + i]
        k[S.colliding + i] = c
        k[S.phase_kept + c] = IDLE
        k[S.held_kept + c] = 0
        k[S.waves + c] = 0
        for j in range(TOTALS):
            w[S.impact_total + TOTALS * c + j] = 0.0
        for side in range(2):
            linkage = k[S.linkage_a + c] if side == 0 else k[S.linkage_b + c]
            k[S.chain + _SIDES * c + side] = k[S.linkage_head + linkage]
            k[S.linkage_head + linkage] = _SIDES * c + side


@kernel("void(S, F, I, f8)")
def _draw(S: Scalars, w: Floats, k: Integers, fastest: float) -> None:
    """Make the contacts that act and their neighbours the active ones; at first, given the fastest, who approaches."""
    m = 0
    for i in range(S.n_colliding):
        c = k[S.colliding + i]
        acts = k[S.phase_kept + c] != IDLE
        if fastest > 0.0:
            acts = w[S.rate + 3 * c] < -NOISE * fastest
        k[S.depth + c] = 0 if acts else -1
        k[S.rim + c] = 0
        if acts:
            k[S.active + m] = c
            m += 1
    begin = 0
    for layer in range(1, _LAYERS + 1):
        end = m
        for i in range(begin, end):
            for side in range(2):
                c = k[S.active + i]
                linkage = k[S.linkage_a + c] if side == 0 else k[S.linkage_b + c]
                entry = k[S.linkage_head + linkage] if k[S.linkage_nu + linkage] > 0 else -1
                while entry >= 0:
                    other = entry // _SIDES
                    if k[S.depth + other] < 0:
                        k[S.depth + other] = layer
                        k[S.rim + other] = 1 if layer == _LAYERS else 0
                        k[S.active + m] = other
                        m += 1
                    entry = k[S.chain + entry]
        begin = end
    S.n_active = m


@kernel("void(S, F, I)")
def _load(S: Scalars, w: Floats, k: Integers) -> None:
    """Set matrix, rates and state of the window, whose structure takes the place of the island's."""
    link_active(S, w, k)
    assemble_delassus(S, w, k)
    for a in range(S.n_active):
        c = k[S.active + a]
        for r in range(3):
            w[S.impact_z0 + 3 * a + r] = w[S.prescribed_rate + 3 * c + r] + row(S, w, k, c, r, S.u_impact)
        for i in range(STRIDE):
            w[S.impact_y + STRIDE * a + i] = 0.0
        w[S.impact_y + STRIDE * a + DEFORMATION] = w[S.impact_total + TOTALS * c + _DEFORMATION]
        w[S.impact_y + STRIDE * a + ENERGY] = w[S.impact_total + TOTALS * c + _ENERGY]
        w[S.impact_y + STRIDE * a + LOST] = w[S.impact_total + TOTALS * c + _LOST]
        w[S.stored + a] = w[S.returned + a] = w[S.impact_mark + a] = 0.0
        k[S.phase + a] = k[S.phase_kept + c]
        k[S.tangent_held + a] = k[S.held_kept + c]


@kernel("void(S, F, I)")
def _store(S: Scalars, w: Floats, k: Integers) -> None:
    """Give the bodies the impulses of the window, and keep what goes on."""
    for a in range(S.n_active):
        c = k[S.active + a]
        account(S, w, k, a)
        total = S.impact_total + TOTALS * c
        for r in range(3):
            w[S.impulse + 3 * a + r] = w[S.impact_y + STRIDE * a + IMPULSE + r]
            w[total + _IMPULSE + r] += w[S.impulse + 3 * a + r]
        w[total + _STORED] += w[S.stored + a]
        w[total + _RETURNED] += w[S.returned + a]
        w[total + _RUBBED] += w[S.impact_y + STRIDE * a + RUBBED]
        w[total + _DEFORMATION] = w[S.impact_y + STRIDE * a + DEFORMATION]
        w[total + _ENERGY] = w[S.impact_y + STRIDE * a + ENERGY]
        w[total + _LOST] = w[S.impact_y + STRIDE * a + LOST]
        k[S.phase_kept + c], k[S.held_kept + c] = k[S.phase + a], k[S.tangent_held + a]
    add_response(S, w, k, S.impulse, S.u_impact)


@room("i8(S, F, I)")
def windowed_impact(S: Scalars, w: Floats, k: Integers) -> int:
    """Do what ``energetic_impact`` does, for many contacts; the Delassus matrix of all of them is not needed."""
    fastest = 0.0
    for a in range(S.n_active):
        fastest = max(fastest, -w[S.rate + 3 * k[S.active + a]])
    S.faint = _FAINT * S.impact_rtol
    S.may_be_lone = 1
    S.truncated = 0
    S.slow_steps = 0
    _gather_colliding(S, w, k)
    outcome = MOVED
    for window in range(_MOST_WINDOWS):
        _draw(S, w, k, fastest if window == 0 else 0.0)
        _load(S, w, k)
        S.lone = -1
        shortest = scale_impact(S, w, k, fastest)
        if not shortest > 0.0:
            outcome = INVALID
            break
        if window == 0:
            start_impact(S, w, k, PROBE * shortest, 0.0)
            S.impact_h = first_step(S, shortest)
        outcome = run_impact(S, w, k, S.impact_h, shortest, 1)
        _store(S, w, k)
        if outcome != MOVED:
            break
    S.faint = 0.0
    S.n_active = S.n_colliding
    for a in range(S.n_active):
        c = k[S.colliding + a]
        k[S.active + a] = c
        total = S.impact_total + TOTALS * c
        for r in range(3):
            w[S.impulse + 3 * a + r] = w[total + _IMPULSE + r]
        w[S.stored + a], w[S.returned + a] = w[total + _STORED], w[total + _RETURNED]
        w[S.rubbed + a] = w[total + _RUBBED]
    return ENDLESS if outcome == MOVED else outcome
