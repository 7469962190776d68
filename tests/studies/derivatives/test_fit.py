"""Parameters found again in measurements that were made with them."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import nonsmooth as ns
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.solution.state import State
from nonsmooth.studies.derivatives.family import Family
from nonsmooth.studies.derivatives.flow import flow
from nonsmooth.studies.derivatives.least_squares import fit
from scenarios.dumbbell import DumbbellScenario
from scenarios.sliding_rod import SlidingRod

Floats = NDArray[np.float64]
pytestmark = pytest.mark.skipif(PLAIN, reason="hundreds of runs take minutes in plain mode")
TIMES = np.linspace(0.01, 0.2, 20)
BOUNDS = {"restitution": (0.5, 0.9), "friction": (0.05, 0.5)}


def _place(state: State) -> Floats:
    return np.array(state.q[:3])


def _measured(family: Family) -> Floats:
    model, rows = family.model(), list[Floats]()
    state = model.start
    for time in TIMES.tolist():
        state = flow(model, state, time).state
        rows.append(_place(state))
    return np.array(rows)


@pytest.mark.slow
def test_restitution_and_friction_of_a_drift() -> None:
    """From positions with 0.02 mm of noise, some of them missing, and a start that is far off."""
    family = Family.of(DumbbellScenario(mode="drift"), ns.EventDriven())
    measured = np.random.default_rng(3).normal(_measured(family), 2e-5)
    measured[4, 1] = np.nan
    found = fit(
        family.at(restitution=0.8, friction=0.4), BOUNDS, at=TIMES, measured=measured, observe=_place, starts=32
    )
    for name, value in {"restitution": 0.65, "friction": 0.2}.items():
        assert abs(found.values[name] - value) < 3.0 * found.standard_errors[name]
        assert found.standard_errors[name] < 0.01
    assert found.deviation == pytest.approx(2e-5, rel=0.4)


def test_bad_input() -> None:
    scenario = DumbbellScenario(mode="drift")
    zeros = np.zeros((len(TIMES), 3))
    with pytest.raises(ns.InvalidInput, match="Did you mean 'friction'"):
        fit(scenario, {"frictoin": (0.1, 0.2)}, at=TIMES, measured=zeros, observe=_place)
    with pytest.raises(ns.InvalidInput, match="bounds of friction must be a range around where it begins"):
        fit(scenario, {"friction": (0.3, 0.4)}, at=TIMES, measured=zeros, observe=_place)
    with pytest.raises(ns.InvalidInput, match="more numbers than parameters, but it is 0"):
        fit(scenario, {"friction": (0.1, 0.4)}, at=TIMES, measured=np.nan * zeros, observe=_place)
    with pytest.raises(ns.InvalidInput, match=r"positive, rising times"):
        fit(scenario, {"friction": (0.1, 0.4)}, at=TIMES[::-1], measured=zeros, observe=_place)
    with pytest.raises(ns.InvalidInput, match=r"bounds must name parameters, but it is \{\}"):
        fit(scenario, {}, at=TIMES, measured=zeros, observe=_place)
    with pytest.raises(ns.InvalidInput, match="observe must be an array of numbers"):
        fit(scenario, {"friction": (0.1, 0.4)}, at=TIMES, measured=zeros, observe=lambda state: "far", starts=2)


@pytest.mark.slow
def test_what_changes_nothing_is_not_told() -> None:
    """A rod that slides and never strikes has no restitution: any value fits, none with an error of 0."""
    times = np.linspace(0.01, 0.1, 6)
    family = Family.of(SlidingRod(friction=0.3, restitution=0.5))
    heights = family.model().run(0.1).at(times)["q"][:, 2]
    bounds = {"friction": (0.1, 0.6), "restitution": (0.2, 0.9)}
    with pytest.raises(ns.InvalidInput, match=r"measurements tell, but it is \['restitution'\]"):
        fit(family, bounds, at=times, measured=heights, observe=lambda state: state.q[2], starts=4)
    with pytest.raises(ns.InvalidInput, match=r"a row for each of 6 times, but it is \(3,\)"):
        fit(family, bounds, at=times, measured=heights[:3], observe=lambda state: state.q[2])
