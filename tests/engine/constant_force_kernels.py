"""Single kernels of forces, averagings and impacts that need a constant; they run as plain Python only."""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any
from unittest.mock import patch

from nonsmooth.engine.contact import implicit_slip, mean_forces
from nonsmooth.engine.events import averaging
from nonsmooth.engine.flow import follow
from nonsmooth.engine.impact import guards, problem, scales
from nonsmooth.engine.impact.rates import COMPRESSION
from nonsmooth.engine.memory.modes import SLIDE, STICK
from nonsmooth.engine.numerics import null_band

_UNREAD: Any = None
"""A heap that a kernel by itself does not read."""


def _let_go(excess: float, deficient: int) -> int:
    """Return how many slips are let go that are held by so much more than the bound of friction."""
    bound = 0.3
    active = SimpleNamespace(mode_past=SLIDE, mode_tried=STICK, at_rest=1, mu=bound, normal_force=1.0)
    active.friction = (bound * (1.0 + excess), 0.0)
    S = SimpleNamespace(n_active=1, active_forces=0, deficient=deficient)
    with patch.multiple(
        implicit_slip, active_at=lambda *_: active, shift_forces=lambda *_: None, distribute=lambda *_: 1
    ):
        return int(implicit_slip._stop_and_go(S, [1.0, *active.friction], _UNREAD))


def holds_at_the_bound() -> None:
    """Hold a slip at the bound of friction but for round-off, and let one go that is past it."""
    assert _let_go(1e-15, 0) == 0
    assert _let_go(1e-6, 0) == 1


def holds_shared_loads() -> None:
    """Hold one that shares its load within what the share is found to."""
    assert _let_go(1e-11, 1) == 0
    assert _let_go(1e-6, 1) == 1


def averages_for_a_while() -> None:
    """Average forces for more than a contact time where they are accurate, but for no more than a hundred."""
    contact = SimpleNamespace(averaged=STICK, mean_span=1.0)
    with patch.multiple(
        mean_forces,
        active_at=lambda *_: SimpleNamespace(slot=0),
        contact_at=lambda *_: contact,
        averaging_time=lambda *_: 1e-5,
    ):
        span = mean_forces.averaging_span(SimpleNamespace(n_active=1), _UNREAD, _UNREAD, 1)
    assert 2e-5 < span <= 1e-3


def _held_up(evaluations: int) -> int:
    """Return the contact whose slip holds time up with so many evaluations of forces at one time, or -1."""
    S = SimpleNamespace(n_grouped=1, grouped=0, crowd=0.0, crowd_t=0.0, t=0.0, evaluations=evaluations, evaluated=0)
    contact = SimpleNamespace(contact_time=1e-5, slip_end=(1e-7, 0.0), force=(1.0, 0.3, 0.0), mobility=10.0)
    contact.mode, contact.averaged, S.velocity_tolerance = SLIDE, 0, 1e-8
    contact.crowd_start, contact.crowd_events = 0.0, 0
    with patch.object(averaging, "contact_at", lambda *_: contact):
        return int(averaging.holds_time_up(S, _UNREAD, [0]))


def lets_slips_stop() -> None:
    """Let a slip stop in a thousand evaluations, but average forces where a million do not get on."""
    assert _held_up(1000) == -1
    assert _held_up(10**6) == 0


def settles_in_time() -> None:
    """Try a step in which slips settle once more only: its error grows with the power 2.5 of its length."""
    for error in (1.1, 5.0, 30.0):
        assert 0.5 < error * problem._shorter(SimpleNamespace(turning=1), error) ** 2.5 <= 1.0


def _passes(force: float) -> int:
    """Return 1 if a force of a contact that shares its load with one of unit force passes its bound."""
    contacts = [SimpleNamespace(redundant=1, holds=0, force=(f, 0.0, 0.0)) for f in (1.0, force)]
    record: dict[str, Any] = {
        "contact_at": lambda S, w, k, c: contacts[c],
        "hold_guard": lambda S, w, k, c: contacts[c].force[0],
    }
    with patch.multiple(follow, **record):
        return int(follow._past_bounds(SimpleNamespace(n_grouped=2, grouped=0), _UNREAD, [0, 1]))


def chooses_forces_anew() -> None:
    """Choose forces anew that pull, but none that do so by round-off."""
    assert _passes(-1e-12) == 0
    assert _passes(-1e-4) == 1


def _symmetric(part: float) -> int:
    """Return 1 if a matrix counts as symmetric whose entries differ by so much."""
    S = SimpleNamespace(reduced=0, half_band=2)
    return int(null_band._is_symmetric(S, [1.0, 0.1, 0.1 + part, 1.0], 2))


def tells_friction_from_round_off() -> None:
    """Take a matrix as symmetric that is but for round-off, and none that friction of a slip has made another one."""
    assert _symmetric(1e-16) == 1
    assert _symmetric(1e-3) == 0


def removes_the_null_space() -> None:
    """Leave nothing of a vector in the null space, though its projector is off by a thousandth."""
    S, w = SimpleNamespace(matrix=1), [1.0, 0.0]

    def project(S: Any, w: Any, n: int, v: int) -> None:
        w[v] *= 0.999

    with patch.object(null_band, "project_on_null", project):
        null_band._remove_null(S, w, 1, 0)
    assert abs(w[0]) < 1e-10


def leaves_rest() -> None:
    """Ask again for friction where a slip stays next to rest for many steps, but not at once."""
    S = SimpleNamespace(n_active=1, slow_steps=0, active_forces=0)
    active = SimpleNamespace(phase=COMPRESSION, tangent_held=0, mu=0.3, slip=(1e-12, 0.0), rest_slip=1e-9)
    with patch.multiple(problem, active_at=lambda *_: active, add_product=lambda *_: 0.0):
        asked = [problem._stopping(S, _UNREAD, _UNREAD) for _step in range(100)]
    assert 1 in asked
    assert asked[:3] == [0, 0, 0]


def grows_with_the_energy() -> None:
    """Let the scale of impulses grow where a contact takes up far more than its approach brings, but not every step."""
    S, active, changes = SimpleNamespace(n_active=1), SimpleNamespace(impulse_scale=1.0), []
    energy = [1.0]
    with patch.multiple(
        scales,
        active_at=lambda *_: active,
        diagonal_block=lambda *_: SimpleNamespace(nn=1.0),
        reached_energy=lambda *_: energy[0],
        _set_rest_slips=lambda *_: changes.append(1),
    ):
        for _step in range(1000):
            energy[0] *= 1.02
            scales.grow_scales(S, _UNREAD, _UNREAD)
    assert active.impulse_scale**2 > 0.1 * energy[0]
    assert len(changes) < 100


def _compresses(deformation: float) -> float:
    """Return the guard of the energy of a contact in compression, of which so much has come, relative to a full one."""
    S = SimpleNamespace(n_active=1, speed_scale=1.0, lone=-1, turning=0, faint=0.0)
    active = SimpleNamespace(slot=0, gap_rate=-1.0, phase=COMPRESSION, force_scale=1.0, deformation_scale=1.0)
    active.tangent_held, active.mu = 0, 0.0
    with patch.multiple(
        guards,
        evaluate_margins=lambda *_: None,
        active_at=lambda *_: active,
        contact_at=lambda *_: None,
        impact_state=lambda *_: SimpleNamespace(deformation=deformation),
    ):
        guards.write_impact_guards(S, _UNREAD, _UNREAD, 0)
    return float(active.energy_guard)


def begins_to_compress() -> None:
    """Let a compression go on whose deformation is none but for round-off, and end one that is far below zero."""
    assert _compresses(-1e-14) > 0.0
    assert _compresses(-1e-3) < 0.0


FORCE_KERNELS: dict[str, tuple[Any, Callable[[], None]]] = {
    "contact.implicit_slip._ARRIVED": (0.0, holds_shared_loads),
    "contact.implicit_slip._FAINT": (0.0, holds_at_the_bound),
    "contact.mean_forces._LONGEST": (1e9, averages_for_a_while),
    "events.averaging._BURST": (1e300, lets_slips_stop),
    "impact.problem._SETTLING": (-0.2, settles_in_time),
    "flow.follow._EXCESS": (0.0, chooses_forces_anew),
    "impact.guards._SLACK": (0.0, begins_to_compress),
    "impact.problem._PATIENCE": (10**9, leaves_rest),
    "impact.scales._GROWN": (1e9, grows_with_the_energy),
    "numerics.null_band._REMOVALS": (1, removes_the_null_space),
    "numerics.null_band._SYMMETRIC": (0.0, tells_friction_from_round_off),
}
"""By constant: another value, and what holds with the present one only."""
