"""What makes a run that reached its end suspect: both sides of every bound."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from bodies import Ball, Plate, Rest
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.solution.energy import EnergyAccount
from nonsmooth.solution.suspicion import (
    broken_promise,
    jumped,
    long_quaternion,
    open_event,
    open_run,
    pushed,
    suspicions,
)


def _account(unexplained: float, potential: float = 0.0) -> EnergyAccount:
    """1 J falls and is lost to friction but for a part."""
    return EnergyAccount(0.0, potential + 1.0, 0.0, potential, 0.0, 0.0, 1.0 - unexplained, 0.0, 1.0, 0.0)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_an_account_open_by_more_than_a_thousand_tolerances_is_named(sign: float) -> None:
    """The exchange is 2 J, so that 2e-6 J are explained at a tolerance of 1e-9."""
    assert open_run(_account(sign * 1.9e-6), 1e-9, 10) == ""
    assert "open by 2.1e-06 J" in open_run(_account(sign * 2.1e-6), 1e-9, 10)
    assert open_run(_account(sign * 2.1e-6), 1e-8, 10) == ""


def test_every_step_may_leave_its_tolerance() -> None:
    """Of a long run more is explained, in proportion: 1e-4 of the exchange of 2 J by 100 000 steps."""
    assert open_run(_account(1.9e-4), 1e-9, 100_000) == ""
    assert "open by 0.00021 J" in open_run(_account(2.1e-4), 1e-9, 100_000)


def test_round_off_of_a_large_potential_energy_is_none() -> None:
    """At 1e9 J above zero 1 J is known to some 1e-7 J only."""
    assert open_run(_account(1e-4, 1e9), 1e-9, 10) == ""
    assert open_run(_account(1e-2, 1e9), 1e-9, 10) != ""


def test_slow_motion_is_known_to_a_part_of_the_scale_of_velocities() -> None:
    """Ten steps, each to 1e-9 of velocities of a Joule, explain 1.4e-14 J of 2e-12 J, of bodies of weight and size."""
    slow = EnergyAccount(0.0, 1e-12, 0.0, 0.0, 0.0, 0.0, 1e-12 - 1e-14, 0.0, 1e-12, 0.0)
    assert "open by 1e-14 J" in open_run(slow, 1e-9, 10)
    assert open_run(slow, 1e-9, 10, 1.0, 1e-10) == ""
    assert "open by 1e-14 J" in open_run(slow, 1e-9, 5, 1.0, 1e-10)


def test_no_number_of_steps_explains_a_thousandth() -> None:
    """Of what is exchanged, 2 J, or of a floor; an engine with larger tolerances promises less."""
    assert open_run(_account(1.9e-3), 1e-9, 10**9) == ""
    assert "open by 0.0021 J" in open_run(_account(2.1e-3), 1e-9, 10**9)
    assert "open by 0.0021 J" in open_run(_account(2.1e-3), 1e-9, 10, 1e12)
    assert open_run(_account(2.1e-3), 1e-9, 10**9, 0.0, 3.0) == ""
    assert open_run(_account(2.1e-3), 1e-5, 10) == ""
    assert "open by 0.021 J" in open_run(_account(2.1e-2), 1e-5, 10)


def test_springs_may_gain_a_thousandth_by_jumps() -> None:
    """Of what is exchanged, 2 J, or of a floor."""
    assert jumped(0.5, 1.9e-3, _account(0.0)) == ""
    assert jumped(0.5, 2.1e-3, _account(0.0), 3.0) == ""
    assert "at t = 0.5 s, brought 0.0021 J" in jumped(0.5, 2.1e-3, _account(0.0))


def test_friction_may_bring_in_a_thousandth() -> None:
    """Of what is exchanged, 2 J, or of a floor."""
    assert pushed(1.9e-3, _account(0.0)) == ""
    assert pushed(2.1e-3, _account(0.0), 3.0) == ""
    assert "brought in 0.0021 J, 0.00105 of" in pushed(2.1e-3, _account(0.0))


def test_an_event_is_named_with_time_and_energy() -> None:
    """From a share of one on."""
    assert open_event(0.5, 1e-3, 1.0) == ""
    assert "at t = 0.5 s 0.001 J appear" in open_event(0.5, 1e-3, 1.1)
    assert "0.001 J vanish" in open_event(0.5, -1e-3, 1.1)


def test_a_long_quaternion_is_named_with_its_body_and_time() -> None:
    """The third of four bodies, at the second sample."""
    bodies = {"floor": Plate(Rest()), "one": Ball(0.01), "two": Ball(0.02), "three": Ball(0.03)}
    t = np.array([0.0, 0.1, 0.2])
    q = np.tile([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0], (3, 3))
    assert long_quaternion(bodies, t, q, 1e-6) == ""
    q[1, 7 + 4] = 1e-3  # half its square, 5e-7, is explained
    assert long_quaternion(bodies, t, q, 1e-6) == ""
    q[1, 7 + 3] = 1.0 + 2e-6
    assert "quaternion of 'two'" in long_quaternion(bodies, t, q, 1e-6)
    assert "t = 0.1 s" in long_quaternion(bodies, t, q, 1e-6)
    assert long_quaternion(bodies, t[:0], q[:0], 1e-6) == ""


def test_all_that_is_found_is_said() -> None:
    """Nothing for nothing; when an account went wrong, if it did."""
    t: Any = np.zeros(0)

    def said(event: tuple[float, float, float], unexplained: float) -> str:
        samples, tolerances = (t, np.zeros((0, 0))), (1e-9, 1e-8)
        account = _account(unexplained)
        return suspicions(
            EventDriven(), event, (0.0, 0.0), 0.0, account, {}, samples, tolerances, 10, 0.0, 0.0, lambda: "At noon."
        )

    assert said((0.0, 0.0, 0.0), 0.0) == ""
    both = said((0.5, 1e-3, 2.0), 1e-3)
    assert "at the event" in both
    assert "; the energy account" in both
    assert ". At noon. Smaller tolerances" in both
    assert "EventDriven(tolerance=" in both
    assert "At noon" not in said((0.5, 1e-3, 2.0), 0.0)


def test_an_engine_is_held_to_the_residual_that_it_promises() -> None:
    """Of the 2 J exchanged, or of the floor."""
    assert broken_promise(_account(1.9e-2), 1e-2, "Midpoint") == ""
    assert "open by 0.021 J, 0.0106 of" in broken_promise(_account(2.1e-2), 1e-2, "Midpoint")
    assert "of which Midpoint promises 0.01 at most" in broken_promise(_account(2.1e-2), 1e-2, "Midpoint")
    assert broken_promise(_account(2.1e-2), 1e-2, "Midpoint", 3.0) == ""
