"""Single kernels of lists, instants, windows and shared forces that need a constant; they run as plain Python only."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch

import nonsmooth as ns
from bodies import Ball
from nonsmooth.engine.bodies import listing, touching
from nonsmooth.engine.contact import null_space_forces
from nonsmooth.engine.contact.trial import NO_FORCE
from nonsmooth.engine.events import accumulation, event_update
from nonsmooth.engine.flow import guards
from nonsmooth.engine.flow.self_check import NOUGHT
from nonsmooth.engine.impact import scales, window
from nonsmooth.engine.memory.modes import NO_SLOT, OPEN, RUNNING, SLIDE
from nonsmooth.engine.native.kernel import contact_at
from tests.engine.constant_kernels import _root
from tests.engine.plain_cases import CASES
from tests.engine.test_clearance import LAWS, R

_UNREAD: Any = None
"""A heap that a kernel by itself does not read."""
_ENDLESS = 1000
"""Rounds after which a loop counts as endless."""


def leaves_the_near_end() -> None:
    """Find where a guard vanishes that falls so steeply that secants stay at the start, by halves of what is left."""
    theta, _, looks = _root(lambda theta: -math.expm1(40.0 * (theta - 0.7)), -math.expm1(-28.0))
    assert abs(theta - 0.7) < 1e-8
    assert looks < 50


def _narrowed(room: float) -> tuple[int, int]:
    """Return how a list ends whose pools have room for such a margin [its widest], and how many were tried."""
    S = SimpleNamespace(widest_margin=1.0, margin_of_list=1.0, listings=0, n_units=1, n_walls=0, t=0.0, y=0)
    tried: list[float] = []

    def fill(*_: Any) -> int:
        tried.append(S.margin_of_list)
        return RUNNING if S.margin_of_list <= room else NO_SLOT

    unit = SimpleNamespace(frame=0, axes=[0.0] * 9, places=[0.0] * 3, radius=0.0)
    with patch.multiple(
        listing,
        fill_pools=fill,
        unit_at=lambda *_: unit,
        frame_at=lambda *_: SimpleNamespace(origin=0.0, rotation=[0.0] * 9),
        evaluate_bodies=lambda *_: None,
        _leave=lambda *_: None,
        _sort_units=lambda *_: None,
    ):
        S.unit_order = 0
        return int(listing.list_contacts(S, _UNREAD, [0])), len(tried)


def lists_what_is_near() -> None:
    """Narrow a list to a thousandth where there is room for no more, and give up soon where there is none at all."""
    assert _narrowed(1e-3)[0] == RUNNING
    status, tried = _narrowed(0.0)
    assert status == NO_SLOT
    assert tried < 20


def _past_the_end(beyond: float) -> tuple[float, int]:
    """Return what is left to the end of the features of a contact so far past it [m], and whether it may touch."""
    S = SimpleNamespace(gap_tolerance=1e-12, time_tolerance=1e-12, velocity_tolerance=1e-8)
    contact = SimpleNamespace(beyond=beyond, gap=1e-13, rate=(0.0, 0.0, 0.0), mode=SLIDE, normal_function=0)
    contact.feature = contact.touching = -1
    with patch.object(guards, "contact_at", lambda *_: contact):
        left = float(guards.feature_guard(S, _UNREAD, _UNREAD, 0))
    nothing: dict[str, Any] = dict.fromkeys(
        ("evaluate_kinematics", "evaluate_jacobian", "evaluate_bias"), lambda *_: None
    )
    with patch.multiple(touching, contact_at=lambda *_: contact, is_on_course=lambda *_: 0, **nothing):
        touching._touch(S, _UNREAD, _UNREAD, 0)
    return left, contact.touching


def drops_what_has_ended() -> None:
    """Let no contact touch where its features end, on whichever side of that the event is found by round-off."""
    near, far = 0.0, 1e-9
    while far - near > 1e-16:
        middle = 0.5 * (near + far)
        near, far = (middle, far) if _past_the_end(middle)[0] > 0.0 else (near, middle)
    assert [_past_the_end(place)[1] for place in (near - 1e-14, far + 1e-14)] == [0, 0]


class _Instant:
    """An instant in which nothing collides, of one island; what is done in it, by name."""

    def __init__(self, facings: float, turning: float) -> None:
        self.done: list[str] = []
        self._facings, self._turning = facings, turning

    def _solve(self, *_: Any) -> int:
        self.done.append("solve")
        return 2 if self.done.count("solve") <= self._facings else 1

    def _creeps(self, *_: Any) -> int:
        return 1 if self.done.count("project") < self._turning else 0

    def _project(self, *_: Any) -> float:
        self.done.append("project")
        return 0.0

    def settle(self) -> int:
        """Return the status behind it."""
        S = SimpleNamespace(mean_until=1e300, n_contacts=1, stopped=0, closing_loss=0.0)
        nothing: dict[str, Any] = dict.fromkeys(
            ("open_account", "remember", "_expect", "_adopt", "_finish"), lambda *_: None
        )
        none: dict[str, Any] = dict.fromkeys(("touch", "interrupted", "close_contacts"), lambda *_: 0)
        with patch.multiple(
            event_update,
            _solve_islands=self._solve,
            _creeps=self._creeps,
            project_closed=self._project,
            **nothing,
            **none,
        ):
            return int(event_update.update_at_event(S, _UNREAD, _UNREAD, 0, -1))


def faces_the_other_way() -> None:
    """Solve again for friction that opposes the other way, but not for ever where contacts turn each other."""
    once, ever = _Instant(1, 0), _Instant(math.inf, 0)
    assert once.settle() == ever.settle() == RUNNING
    assert once.done == ["solve", "solve"]


def solves_behind_the_projection() -> None:
    """Solve again behind a projection that may have turned a slip, but not for ever where the next one may, too."""
    once, ever = _Instant(0, 1), _Instant(0, math.inf)
    assert once.settle() == ever.settle() == RUNNING
    assert once.done == ["solve", "project", "solve"]
    assert ever.done[-1] == "solve"


def _may_turn(speed: float) -> int:
    """Return 1 if a projection may turn a slip so fast [velocity tolerances]."""
    S = SimpleNamespace(n_contacts=2, velocity_tolerance=1e-8)
    contact = SimpleNamespace(mode=SLIDE, normal_function=0, averaged=OPEN)
    with patch.multiple(event_update, contact_at=lambda *_: contact, slip_speed=lambda *_: speed * 1e-8):
        return int(event_update._creeps(S, _UNREAD, _UNREAD))


def turns_slow_slips() -> None:
    """Look again at a slip that one tolerance across it turns by more than a degree, but not at a fast one."""
    assert _may_turn(1.0 / math.tan(math.radians(1.0))) == 1
    assert _may_turn(1e6) == 0


def _bounces_shorter(than: float) -> int:
    """Return how many islands of two contacts end their bounces, whose way up takes so many averagings."""
    time, approach = 1e-5, 9.81
    S = SimpleNamespace(
        n_groups=1, n_active=2, velocity_tolerance=1e-8, gap_tolerance=1e-12, time_tolerance=1e-12, du=0
    )
    contact = SimpleNamespace(rate=(than * approach * time, 0.0, 0.0), bias=(-approach, 0.0, 0.0), gap=0.0)
    with patch.multiple(
        accumulation,
        group_touching=lambda *_: None,
        activate_group=lambda *_: None,
        averaging_time=lambda *_: time,
        active_at=lambda *_: SimpleNamespace(slot=0),
        contact_at=lambda *_: contact,
        row=lambda *_: 0.0,
        closed_twin=lambda *_: -1,
        average_active=lambda *_: 1,
        EXPLAINED=math.inf,
    ):
        return int(accumulation.close_contacts(S, _UNREAD, _UNREAD))


def rests_as_an_averaging_ends() -> None:
    """Begin no averaging for a contact that comes to rest, but for round-off, as the last one would have ended."""
    assert _bounces_shorter(1.0 - 1e-12) == 0
    assert _bounces_shorter(0.99) == 1


def knows_its_deformation() -> None:
    """Find the deformation that takes up the energy of an approach, of a force law that is no power."""
    S = SimpleNamespace(n_active=1, impact_rtol=1e-8, lone=-1)
    active = SimpleNamespace(slot=0, gap_rate_before=-1.0)
    with patch.multiple(
        scales,
        active_at=lambda *_: active,
        diagonal_block=lambda *_: SimpleNamespace(nn=1e3),
        contact_at=lambda *_: SimpleNamespace(force_function=0, force_parameters=0),
        at=lambda *_: None,
        call_scalar=lambda f, x, p: 1e5 * (x + 1e3 * x * x),
        _set_rest_slips=lambda *_: None,
    ):
        scales.scale_impact(S, _UNREAD, _UNREAD, 0.0)
    x = active.deformation_scale
    assert abs(1e5 * (x + 1e3 * x * x) * x / active.energy_scale - 1.0) < 1e-4


def _share(found: int) -> tuple[Any, list[tuple[float, float]]]:
    """Return a contact whose share of the forces is chosen, and for what insets and errors it was looked for."""
    S, asked = SimpleNamespace(n_active=1, n_unknown=1, active=0, x=0, active_forces_first=1), []
    contact = SimpleNamespace(slack=0.0, null_space_force=[0.0, 0.0, 0.0])

    def distribute(S: Any, w: Any, k: Any, inset: float, arrived: float) -> int:
        asked.append((inset, arrived))
        assert len(asked) < _ENDLESS
        return found

    with patch.multiple(
        null_space_forces,
        active_at=lambda *_: SimpleNamespace(slot=0),
        contact_at=lambda *_: contact,
        set_force=lambda *_: None,
        _least_distance=lambda *_: 0.0,
        _keep_null_space_force=lambda *_: None,
        distribute=distribute,
    ):
        null_space_forces.choose_null_space_force(S, [1.0, 0.0], _UNREAD)
    return contact, asked


def keeps_bounds_that_it_looks_for() -> None:
    """Count no force as away from its bound that is past it by what counts as arrived."""
    asked = _share(0)[1]
    assert all(0.0 < arrived < inset for inset, arrived in asked if inset > 0.0)


def lets_go_of_what_pulls_only() -> None:
    """Let a bound hold that is passed by what the contact problem takes for no force, but by not much more."""
    assert NO_FORCE < _share(0)[0].slack < 1e3 * NO_FORCE
    assert _share(1)[0].slack == 0.0


def _windows() -> list[int]:
    """Return how many contacts stand in each window of the impact of a row of eighteen balls, which has 17."""
    drawn: list[int] = []
    load = window._load

    def count(S: Any, w: Any, k: Any) -> None:
        drawn.append(S.n_active)
        load(S, w, k)

    with patch.object(window, "_load", count):
        CASES["long row"]()
    return drawn


def looks_through_windows() -> None:
    """Look at less than half of a long row where its impact begins, and draw windows of it less often than that."""
    drawn = _windows()
    assert drawn
    assert drawn[0] < 0.5 * 17
    assert len(drawn) < 0.5 * 17


def stops_a_row_that_creeps() -> None:
    """Stop a row of open contacts, of which the first approaches slower than what counts as motion, at all of them."""
    n, counts_as_motion = 12, 2e-8
    balls = [Ball(R) for _ in range(n)]
    system = ns.System(balls, gravity=0.0)
    for i, ball in enumerate(balls):
        if i:
            system.contact(balls[i - 1], ball, **LAWS)
        system.place(ball, position=(2.0 * R * i, 0.0, 0.0), velocity=(0.0 if i else 0.25 * counts_as_motion, 0.0, 0.0))
    speeds = [0.0] * n

    def stop_open(S: Any, w: Any, k: Any) -> float:
        for c in range(S.n_contacts):
            contact_at(S, w, k, c).mode = OPEN
        loss = float(accumulation.stop_creeping(S, w, k))
        speeds[:] = [w[S.y + S.n_q + 6 * i] for i in range(n)]
        return loss

    with patch.multiple(event_update, project_closed=lambda *_: 0.0, stop_creeping=stop_open):
        ns.simulate(system, 1e-9, engine=ns.EventDriven(velocity_tolerance=counts_as_motion))
    assert math.isclose(sum(speeds), 0.25 * counts_as_motion)
    assert min(after - before for before, after in pairwise(speeds)) > -NOUGHT * counts_as_motion


EVENT_KERNELS: dict[str, tuple[Any, Callable[[], None]]] = {
    "flow.location._SLOW": (10**9, leaves_the_near_end),
    "bodies.listing._NARROWEST": (1.0, lists_what_is_near),
    "flow.guards.LATE": (1.0, drops_what_has_ended),
    "events.event_update._FACINGS": (10**9, faces_the_other_way),
    "events.event_update._PROJECTIONS": (0, solves_behind_the_projection),
    "events.event_update._SLOW": (1.0, turns_slow_slips),
    "events.accumulation._RESTS": (1.0, rests_as_an_averaging_ends),
    "impact.scales._MET": (1.0, knows_its_deformation),
    "contact.null_space_forces._ARRIVED": (1e-3, keeps_bounds_that_it_looks_for),
    "contact.null_space_forces._SLACK": (0.0, lets_go_of_what_pulls_only),
    "contact.cone.SWEEPS": (20, stops_a_row_that_creeps),
    "impact.window.LARGE": (10**6, looks_through_windows),
    "impact.window._LAYERS": (1, looks_through_windows),
}
"""By constant: another value, and what holds with the present one only."""
