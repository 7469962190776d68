"""What an evaluation of an impact's forces leaves out: friction of contacts that are idle or have none."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from laws import Coulomb, EnergeticImpact, Frictionless
from nonsmooth.engine.contact.problem import follow_slip
from nonsmooth.engine.impact import rates
from nonsmooth.engine.impact.rates import IDLE
from nonsmooth.engine.native.kernel import PLAIN, active_at
from nonsmooth.interfaces import FrictionLaw

pytestmark = pytest.mark.skipif(not PLAIN, reason="the functions are compiled into the engine")


def _strike(friction: FrictionLaw) -> ns.ImpactResult:
    """Return the impact of a ball on a row of four, of mass 1, along their line."""
    n = 5
    normal, tangential = np.zeros((2 * n, n - 1)), np.zeros((2 * n, n - 1, 2))
    for i in range(n - 1):
        for ball, sign in ((i, -1.0), (i + 1, 1.0)):
            normal[2 * ball, i] = tangential[2 * ball + 1, i, 0] = sign
    velocity = np.zeros(2 * n)
    velocity[0] = 1.0
    return ns.solve_impact(
        np.eye(2 * n), normal, tangential, velocity, [EnergeticImpact(1.0)] * (n - 1), [friction] * (n - 1)
    )


def test_contacts_without_friction_are_not_held(monkeypatch: pytest.MonkeyPatch) -> None:
    """No forces are solved for in a row without friction, though nothing slips in it; with friction they are."""
    calls: list[int] = []
    hold = rates._hold

    def note(*arguments: Any) -> None:
        calls.append(1)
        hold(*arguments)

    monkeypatch.setattr(rates, "_hold", note)
    smooth = _strike(Frictionless())
    assert not calls
    rough = _strike(Coulomb(0.3))
    assert calls
    np.testing.assert_allclose(smooth.velocity, rough.velocity, atol=1e-9)


def test_idle_contacts_have_no_friction_to_follow(monkeypatch: pytest.MonkeyPatch) -> None:
    """The slip of a contact that is idle is not followed."""
    phases: list[int] = []

    def note(S: Any, w: Any, k: Any, a: int, *arguments: Any) -> None:
        phases.append(active_at(S, w, k, a).phase)
        follow_slip(S, w, k, a, *arguments)

    monkeypatch.setattr(rates, "follow_slip", note)
    _strike(Frictionless())
    assert phases
    assert IDLE not in phases
