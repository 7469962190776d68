"""Single kernels that need a constant of the engine, on guards that are made up; they run as plain Python only."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch

import numpy as np

import nonsmooth as ns
from laws import Coulomb
from nonsmooth.engine.contact import cone, implicit_slip, null_space_forces, problem, search
from nonsmooth.engine.events import event_update, step_length, stopping, twins
from nonsmooth.engine.flow import ending, leap, location, mean_motion
from nonsmooth.engine.flow import guards as flow_guards
from nonsmooth.engine.impact import guards
from nonsmooth.engine.memory.modes import OPEN, SLIDE
from nonsmooth.engine.memory.solvers import ENUMERATION, LEMKE
from tests.engine.plain_cases import CASES

_UNREAD: Any = None
"""A heap that a kernel by itself does not read."""
_MOST_LOOKS = 1000
"""Looks at a guard after which a search counts as endless."""


def _counted(value: Callable[[float], float]) -> tuple[Callable[[float], float], list[float]]:
    """Return a function that keeps where it was evaluated, and that list."""
    looks: list[float] = []

    def evaluate(theta: float) -> float:
        looks.append(theta)
        assert len(looks) <= _MOST_LOOKS
        return value(theta)

    return evaluate, looks


@contextmanager
def _one_guard(value: Callable[[float], float], first: float, last: float, rises: int = 0) -> Iterator[Any]:
    """Let a step of the flow have one guard, no gap, of these values in it, at its start and at its end."""
    evaluate, looks = _counted(value)
    record = SimpleNamespace(value=last, first=first, end=last, middle=value(0.5), deflated=rises, looks=looks)
    with patch.multiple(
        location,
        guard_at=lambda *_: record,
        kinematic=lambda *_: 0,
        is_gap=lambda *_: 0,
        guards_within=lambda *_: None,
        _guard_at=lambda S, w, k, h, theta, i, forces: evaluate(theta),
    ):
        yield record


def _root(value: Callable[[float], float], first: float, h: float = 1e-3, rises: int = 0) -> tuple[float, float, int]:
    """Return where the guard vanishes within a step of ``h``, with what slope, and how often it was looked at."""
    S = SimpleNamespace(time_tolerance=1e-12, guard_slope=0.0)
    with _one_guard(value, first, value(1.0), rises) as record:
        theta = location._vanishing(S, _UNREAD, _UNREAD, h, 1.0, 0, 1)
        return theta, S.guard_slope, len(record.looks)


def starts_by_chance() -> None:
    """Find where a guard falls that rises from zero, but for round-off, with no rate."""
    theta, _, _ = _root(lambda theta: (theta - 0.3) * (0.6 - theta), 1e-14, rises=1)
    assert abs(theta - 0.6) < 1e-8


def never_positive() -> None:
    """Find by few looks that a guard is negative from the start on."""
    theta, _, looks = _root(lambda theta: -1.0 - theta, -1.0)
    assert theta < 1e-3
    assert looks < 20


def jumps() -> None:
    """Find where a guard jumps to far below zero, and tell that from a slope."""
    theta, slope, _ = _root(lambda theta: 1.0 if theta < 0.3 else -200.0, 1.0, 1e-6)
    assert abs(theta - 0.3) < 1e-8
    assert slope == -math.inf


def dips_between_samples() -> None:
    """Find that a force is negative whose dip the parabola through three samples does not reach."""

    def dip(theta: float) -> float:
        return 1.0 - 1.3 * math.exp(-(((theta - 0.37) / 0.2) ** 2))

    with _one_guard(dip, dip(0.0), dip(1.0)):
        theta = location._lowest(SimpleNamespace(), _UNREAD, _UNREAD, 1e-3, 0)
    assert theta > 0.0
    assert dip(theta) < 0.0


def _first_sample(closing: float, bend: float, faces: tuple[float, float], speed: float = 0.0) -> float:
    """Return the first sample at which a gap has closed whose features face each other in a part of the step only."""
    S = SimpleNamespace(n_contacts=1, n_astray=1, astray=0, gap_looks=0)
    contact = SimpleNamespace(mode=OPEN, size=1.0, gap=1.0, speed_first=speed, speed_end=speed)

    def stand(S: Any, w: Any, k: Any, h: float, theta: float, forces: int) -> None:
        left = closing - theta
        contact.gap, contact.gap_rate = left + bend * left * abs(left), -1.0 - 2.0 * bend * abs(left)
        contact.beyond = 0.0 if faces[0] < theta < faces[1] else 1.0
        assert S.gap_looks < 20 * _MOST_LOOKS

    def fired(*_: Any) -> int:
        return 0 if contact.beyond <= 0.0 and contact.gap < 0.0 else -1

    with patch.multiple(
        location,
        contact_at=lambda *_: contact,
        guards_within=stand,
        first_fired=fired,
        arm_further=lambda *_: None,
        _asks_forces=lambda *_: 0,
    ):
        return float(location._sampled(S, _UNREAD, [0], 1.0, 1.0))


def faces_for_an_instant() -> None:
    """Look at features when they close that face each other between two samples only."""
    assert 0.33 <= _first_sample(0.33, 10.0, (0.3, 0.35)) < 0.331


def passes_fast() -> None:
    """Take no more samples than the step resolves, however fast features pass."""
    assert _first_sample(2.0, 0.0, (2.0, 3.0), 1e9) == 0.0


def _crowd(first: float) -> int:
    """Return how many roots are looked for of guards that fire one before the other without end."""
    roots: list[float] = []

    def root(S: Any, w: Any, k: Any, h: float, high: float, i: int, forces: int) -> float:
        roots.append(high)
        return 0.99 * high

    S = SimpleNamespace(stage_time=0.0, n_contacts=1000, n_astray=0, n_doubtful=0, guard_slope=-1.0)
    with patch.multiple(
        location,
        _asks_forces=lambda *_: 1,
        first_fired=lambda *_: len(roots) % 1000,
        first_own_guard=lambda *_: 0,
        number_of_guards=lambda *_: 1000,
        guard_at=lambda *_: SimpleNamespace(first=first),
        contact_of=lambda *_: 0,
        _event_fraction=root,
    ):
        assert location.locate(S, _UNREAD, _UNREAD, 1e-3, 1.0) < 0.0
    return len(roots)


def crowds() -> None:
    """Give a thousand forces up that fire one before the other before all of them are looked for."""
    assert _crowd(1.0) <= 100


def crowds_that_were_wrong() -> None:
    """Give those up even sooner that were negative from the start."""
    assert _crowd(-1.0) <= 10


def _switch(value: Callable[[float], float]) -> tuple[float, int]:
    """Return where a guard of an impact vanishes within a step, and how often it was looked at."""
    evaluate, looks = _counted(value)
    with patch.object(guards, "_guard_at", lambda S, w, k, h, theta, i: evaluate(theta)):
        S = SimpleNamespace(impact_guard_first=0, guard_slope=0.0)
        theta = guards._switch_fraction(S, [value(0.0)], _UNREAD, 1.0, 1.0, value(1.0), 0)
    return theta, len(looks)


def _falls(theta: float) -> float:
    return math.exp(-theta) - 0.7


def switches() -> None:
    """Find by few looks where a guard is zero, as near as the correction on the step needs it."""
    theta, looks = _switch(_falls)
    assert abs(theta + math.log(0.7)) < 1e-9
    assert looks <= 6


def switches_from_next_to_nothing() -> None:
    """Do the same for one that began as small as round-off."""
    theta, _ = _switch(lambda theta: 1e-12 * _falls(theta))
    assert abs(theta + math.log(0.7)) < 1e-3


def fires_unarmed() -> None:
    """Let no guard end a phase that a switch left below zero by round-off, but one that is far below."""
    S = SimpleNamespace(n_active=1, impact_guard=0, armed=0)
    assert guards.fired_guard(S, [-1e-11, 1.0, 1.0], [0, 1, 1], -1) == -1
    assert guards.fired_guard(S, [-1e-4, 1.0, 1.0], [0, 1, 1], -1) == 0


def switches_on_the_step() -> None:
    """Switch where the guard vanishes on the step itself, though the interpolant is off by a hundredth."""
    root, w = 0.37, [0.0, 1.0, 1.0, 1.0]
    S = SimpleNamespace(n_active=1, impact_guard=1, impact_guard_first=0, armed=0, impact_steps=0)
    S.impact_y = S.impact_new = S.impact_slopes = S.impact_stage = 0

    def on_the_step(S: Any, w: Any, k: Any, step: float) -> float:
        w[1] = (root - step) * (1.0 + step)
        return 0.0

    def off(S: Any, w: Any, k: Any, h: float, high: float, value: float, i: int) -> float:
        S.guard_slope = -1.37
        return root + 1e-2

    with patch.multiple(
        guards,
        try_impact_step=on_the_step,
        write_impact_guards=lambda *_: None,
        evaluate_impact_guards=lambda *_: None,
        fired_guard=lambda S, w, k, but: 0 if but < 0 else -1,
        _switch_fraction=off,
        STRIDE=0,
    ):
        w[0] = 1.0
        guards.locate_switch(S, w, [1, 1, 1], 1.0)
    assert abs(w[1]) < 1e-6


def ends_a_cascade() -> None:
    """Take what approaches behind an impact that was cut short for nothing where it is, by its energy."""

    def is_over(left: float) -> int:
        active = SimpleNamespace(rate_before=(-1.0, 0.3, 0.0), gap_rate=-left)
        with patch.object(event_update, "active_at", lambda *_: active):
            return int(event_update._is_over(SimpleNamespace(n_active=1), _UNREAD, _UNREAD))

    assert is_over(1e-4) == 1
    assert is_over(0.1) == 0


def _longest_averaging(astray: Callable[[float], float], longest: float) -> float:
    """Return over what time forces are averaged that lead gaps astray so far in a time."""
    taken: list[float] = []
    with patch.multiple(
        mean_motion,
        averaging_span=lambda *_: longest,
        find_mean_impulses=lambda S, w, k, time: time,
        _departure=lambda S, w, k, time: astray(time),
        take_mean_forces=lambda S, w, k, time: taken.append(time),
    ):
        mean_motion.find_mean_forces(SimpleNamespace(time_tolerance=1e-12), _UNREAD, _UNREAD, 0)
    return taken[0]


def averages_as_long_as_forces_hold() -> None:
    """Let forces hold though gaps go half as far again astray as is foreseen, and cut by little what is unforeseen."""
    time = _longest_averaging(lambda time: (time / 1e-5) ** 3, 1e-5)
    assert 1.5 * (time / 1e-5) ** 3 <= 1.0
    time = _longest_averaging(lambda time: (time / 1e-5) ** 3 if time < 2e-5 else math.inf, 1e-3)
    assert time > 3e-6


def leads_no_gap_to_where_nothing_explains_it() -> None:
    """Take a step back whose mean forces lead a gap so far that a look at it would end the run."""
    S = SimpleNamespace(n_contacts=1, gap_tolerance=1e-12)
    contact = SimpleNamespace(averaged=1, normal_function=0, beyond=0.0, mean_gap=0.0, mean_way=0.0)
    contact.mean_force, contact.gap = (1.0, 0.0, 0.0), 1e-9
    with patch.multiple(
        mean_motion, contact_at=lambda *_: contact, tolerated_gap=lambda *_: 1e-9, _explained_work=lambda *_: 1.0
    ):
        assert mean_motion.astray(S, _UNREAD, _UNREAD) > step_length._ASTRAY


def _spread(distance: float) -> int:
    """Return how often forces are looked for that are farther from their bounds, of which there are none."""
    S, looks = SimpleNamespace(n_active=1, n_unknown=1, active=0, x=0, active_forces_first=1), []
    S.deficient = 1
    contact = SimpleNamespace(slack=0.0, null_space_force=[0.0, 0.0, 0.0])

    def distribute(*_: Any) -> int:
        looks.append(1)
        assert len(looks) < _MOST_LOOKS
        return 0

    with patch.multiple(
        null_space_forces,
        active_at=lambda *_: SimpleNamespace(slot=0),
        contact_at=lambda *_: contact,
        set_force=lambda *_: None,
        _least_distance=lambda *_: distance,
        _keep_null_space_force=lambda *_: None,
        distribute=distribute,
    ):
        null_space_forces.choose_null_space_force(S, [1.0, 0.0], _UNREAD)
    return len(looks)


def spreads_forces() -> None:
    """Spread forces that are next to a bound, and end that where there are no others."""
    assert 0 < _spread(1e-9) < 10


def _stretches(way: float) -> int:
    """Return in how many stretches a contact point runs so far, in units of its body."""
    contact = SimpleNamespace(point_a=(way, 0.0, 0.0), start_a=(0.0, 0.0, 0.0), size=1.0)
    contact.point_b = contact.start_b = contact.start_a
    with patch.object(leap, "contact_at", lambda *_: contact):
        return int(leap._stretches(SimpleNamespace(n_grouped=1, grouped=0), _UNREAD, [0]))


def runs_across_a_body() -> None:
    """Let a contact point run across half a body in stretches that are short next to it, as its lever turns."""
    assert _stretches(0.5) >= 20


def runs_far() -> None:
    """Ask for no more work where one seems to run a million times as far."""
    assert _stretches(1e6) <= 1000


def rubs_on_the_bound() -> None:
    """Find the friction of a contact that moves along one line only, and is exactly at its bound."""
    assert cone._cut_to_disc(1.0, 0.0, 0.0, 1.0, 0.0, 1.0) == (-1.0, 0.0)


def _solves_by(solver: int) -> None:
    """Solve a small problem that no other solver is let solve."""
    real, friction = search.find_modes, [Coulomb(0.3)] * 2
    columns = np.eye(6).reshape(6, 2, 3)
    force = np.array([-1.0, 0.1, 0.0, -1.0, 0.0, 0.5])
    with patch.object(problem, "find_modes", lambda S, w, k, number: real(S, w, k, number) if number == solver else 0):
        found = ns.solve_contact(np.eye(6), columns[:, :, 0], columns[:, :, 1:], force, friction)
    np.testing.assert_allclose(found.acceleration, [0.0, 0.0, 0.0, 0.0, 0.0, 0.2], rtol=0.0, atol=1e-12)


def follows_a_lone_slip() -> None:
    """Follow a slip that is alone by Newton steps of its direction; few stages ask for a search."""
    with patch.object(implicit_slip, "oppose_slips", side_effect=implicit_slip.oppose_slips) as searches:
        CASES["creeping"]()
    assert searches.call_count < 400


def _fires(value: float, friction: int) -> int:
    """Return 1 if a guard of a sliding contact fires that is not armed: its force (0) or its slip (1)."""
    S = SimpleNamespace(velocity_tolerance=1e-8, gap_tolerance=1e-12)
    contact = SimpleNamespace(mode=SLIDE, normal_function=0, holds=0, small_force_of=1e-9, beyond=0.0)
    guard = SimpleNamespace(value=value, armed=0, deflated=0)
    with patch.multiple(
        flow_guards,
        guard_at=lambda *_: guard,
        contact_at=lambda *_: contact,
        contact_of=lambda *_: 0,
        is_friction_guard=lambda *_: friction,
    ):
        return int(flow_guards.has_fired(S, _UNREAD, _UNREAD, friction))


def slips_back_unarmed() -> None:
    """Let a slip fire that goes back as fast as what counts as motion, but not one by round-off."""
    assert _fires(-1e-12, 1) == 0
    assert _fires(-1e-8, 1) == 1


def pulls_unarmed() -> None:
    """Let a force fire that pulls by more than the contact problem took for zero, but not by what it did."""
    assert _fires(-1e-9, 0) == 0
    assert _fires(-1e-8, 0) == 1


def _are_twins(apart: float) -> int:
    """Return 1 if contacts of the same bodies are one whose normals differ by so much."""
    one, other = (
        SimpleNamespace(
            frame_a=0, frame_b=1, normal_function=0, size=1.0, point_b=(0.0, 0.0, 0.0), normal=(x, 0.0, 1.0)
        )
        for x in (0.0, apart)
    )
    with patch.object(twins, "contact_at", lambda S, w, k, c: other if c else one):
        return int(twins._is_twin(_UNREAD, _UNREAD, _UNREAD, 0, 1))


def stands_for_its_twin() -> None:
    """Take contacts for one whose normals differ by what moves next to no energy, and no others."""
    assert _are_twins(1e-7) == 1
    assert _are_twins(1e-2) == 0


def ends_ahead() -> None:
    """Find the end of the features of a contact five least times ahead, to which steps did not get."""
    S = SimpleNamespace(time_tolerance=1e-12, gap_tolerance=1e-12, t=0.0, y=0, y_new=1, slopes=2, n_y=1)
    S.n_grouped, S.grouped, contact = 1, 0, SimpleNamespace(beyond=-1.0, feature=-1, feature_now=0.0)

    def evaluate(S: Any, w: Any, k: Any, t: float, y: int) -> None:
        contact.beyond = 1.0 if t >= 5e-12 else -1.0

    with (
        patch.multiple(ending, evaluate_bodies=evaluate, evaluate_geometry=lambda *_: None),
        patch.object(flow_guards, "contact_at", lambda *_: contact),
    ):
        assert ending.end_features(S, [0.0, 0.0, 0.0], [0]) == 0


def stops_unforeseen() -> None:
    """Cut a step soon to a thousandth of it where a slip stops in it of which nothing tells when."""
    S = SimpleNamespace(time_tolerance=1e-12, slopes=0, n_q=0, relaxation=1e9, velocity_tolerance=1e-8)
    contact = SimpleNamespace(slip_end=(1e-6, 0.0), bias=(0.0, 1.0, 0.0))
    h, cuts = 1.0, 0
    with patch.multiple(stopping, contact_at=lambda *_: contact, row=lambda *_: 0.0):
        while h > 1e-3:
            h *= stopping._share(S, _UNREAD, _UNREAD, 0, h)
            cuts += 1
    assert 3 <= cuts <= 10


def opens_alike() -> None:
    """Open two contacts together that pull alike but for round-off, as they are each other's image."""
    pulling = [SimpleNamespace(mode_tried=SLIDE, normal_force=-1.0 - 1e-12 * i) for i in range(2)]
    with patch.object(search, "active_at", lambda S, w, k, a: pulling[a]):
        assert search._open_pulling(SimpleNamespace(n_active=2, small_force=1e-9), _UNREAD, _UNREAD) == 2


KERNELS: dict[str, tuple[Any, Callable[[], None]]] = {
    "flow.location._FAINT": (0.0, starts_by_chance),
    "flow.location._SHORTEST": (0.0, never_positive),
    "flow.location._JUMP": (1e9, jumps),
    "flow.location._NEARER": (1e30, jumps),
    "flow.location._NEAR": (0.0, dips_between_samples),
    "flow.location._LOOKS": (0, faces_for_an_instant),
    "flow.location._BEHIND": (0.0, faces_for_an_instant),
    "flow.location._MOST_ROOTS": (10**6, crowds),
    "flow.location._FEW_ROOTS": (10**6, crowds_that_were_wrong),
    "impact.guards._ROUGH": (1.0, switches),
    "impact.guards._SMALL": (1e9, switches_from_next_to_nothing),
    "impact.guards._WRONG": (0.0, fires_unarmed),
    "impact.guards._CORRECTIONS": (1, switches_on_the_step),
    "events.event_update._NEXT_TO_NOTHING": (0.0, ends_a_cascade),
    "flow.mean_motion._AHEAD": (1e9, averages_as_long_as_forces_hold),
    "flow.mean_motion._SHORTER": (1e-9, averages_as_long_as_forces_hold),
    "flow.mean_motion._SHARE": (1e9, leads_no_gap_to_where_nothing_explains_it),
    "events.step_length._ASTRAY": (1e9, leads_no_gap_to_where_nothing_explains_it),
    "contact.null_space_forces._AMPLE": (0.0, spreads_forces),
    "contact.null_space_forces._RUNGS": (1000, spreads_forces),
    "flow.leap._PART": (1.0, runs_across_a_body),
    "flow.leap._MOST": (10**9, runs_far),
    "contact.cone._FLAT": (0.0, rubs_on_the_bound),
    "contact.implicit_slip._TURNS": (1, follows_a_lone_slip),
    "memory.solvers.ENUMERATED_AT_LAST": (0, lambda: _solves_by(ENUMERATION)),
    "memory.solvers.MOST_PIVOTED": (0, lambda: _solves_by(LEMKE)),
    "contact.search._SAME": (0.0, opens_alike),
    "events.stopping._BLIND": (0.999, stops_unforeseen),
    "events.twins._SAME": (0.0, stands_for_its_twin),
    "flow.ending._DOUBLINGS": (0, ends_ahead),
    "flow.flow.WRONG_FORCE": (0.0, pulls_unarmed),
    "flow.guards._WRONG_SLIP": (0.0, slips_back_unarmed),
}
"""By constant: another value, and what holds with the present one only."""
