"""The run of other parameters is not accepted by the criteria of a scenario's default run.

That the default run of every scenario is accepted is a property that the kit looks at (tests/testing).
"""

from __future__ import annotations

from typing import Any

import pytest

import nonsmooth as ns
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.plugins import registry

OTHERS: dict[str, dict[str, Any]] = {
    "ball_box": {"density": 2600.0},
    "bead_column": {"height": 0.06},
    "block_on_belt": {"static_force": 1.1},
    "bouncing_ball": {"orbit": 2.0},
    "bouncing_trimer": {"friction": 0.3},
    "dice_throw": {"density": 1300.0},
    "disc_ball": {"restitution": 0.9},
    "dominoes": {"lean": 0.03},
    "dumbbell": {"gamma": 0.3},
    "egg_on_table": {"spin": 40.0},
    "mesh_drop": {"height": 0.06},
    "mesh_dumbbell": {"subdivisions": 0.0},
    "newtons_cradle": {"exponent": 1.4},
    "polyhedron_stack": {"friction": 0.45},
    "rattleback": {"product": 0.0, "t_end": 2.0},
    "rocking_block": {"height": 0.51},
    "rocking_block_3d": {"mass": 1.1},
    "rolling_disc": {"viscosity": 2e-5},
    "slider_crank": {"restitution": 0.41},
    "sliding_rod": {"friction": 1.3},
    "tippe_top": {"spin": 20.0},
    "two_link_arm": {"friction": 0.4},
    "woodpecker": {"law": "energetic"},
}
"""By name, parameters of which a run must not be taken for the default one."""


def _run(scenario: Scenario) -> ns.Solution:
    return ns.simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval)


def test_all_are_there() -> None:
    assert set(OTHERS) == set(registry.names("scenarios"))


@pytest.mark.fast_cases(1)
@pytest.mark.skipif(PLAIN, reason="full runs take minutes in plain mode")
@pytest.mark.parametrize("name", OTHERS)
def test_another_run_is_not_accepted_for_the_default_one(name: str) -> None:
    owner = registry.load("scenarios", name)
    judged = owner().acceptance(_run(owner(**OTHERS[name])))
    assert not all(one.fulfilled for one in judged)


@pytest.mark.fast_cases(8)
@pytest.mark.skipif(PLAIN, reason="full runs take minutes in plain mode")
@pytest.mark.parametrize(
    ("name", "given", "count"),
    [
        ("dumbbell", {"mode": "jump"}, 3),
        ("dumbbell", {"mode": "flutter"}, 3),
        ("dumbbell", {"mode": "drift", "friction": 0.1}, 0),
        ("bouncing_ball", {"gamma": 0.0, "height": 0.05, "restitution": 0.7, "t_end": 1.0}, 1),
        ("bouncing_ball", {"gamma": 2.5}, 0),
        ("bead_column", {"n_beads": 1.0, "restitution": 0.5}, 2),
        ("block_on_belt", {"damping": 0.3}, 3),
        ("disc_ball", {"offset": 4e-3}, 2),
        ("mesh_drop", {"spin": 20.0}, 2),
        ("newtons_cradle", {"n_balls": 3.0, "exponent": 1.0}, 5),
        ("newtons_cradle", {"restitution": 0.5}, 1),
        ("rocking_block", {"base": 0.6, "tilt": 0.3}, 3),
        ("rocking_block", {"friction": 0.5}, 0),
        ("sliding_rod", {"friction": 1.3}, 1),
        ("egg_on_table", {"spin": 40.0}, 1),
        ("rattleback", {"spin": 4.0, "t_end": 3.0}, 2),
        ("rattleback", {"friction": 0.2, "t_end": 5.0}, 0),
        ("two_link_arm", {"restitution": 0.3, "belt_speed": 0.4}, 4),
        ("tippe_top", {"spin": 20.0, "t_end": 2.0}, 1),
        ("woodpecker", {"law": "energetic"}, 0),
    ],
)
def test_other_parameters_are_judged_by_what_holds_for_them(name: str, given: dict[str, Any], count: int) -> None:
    scenario = registry.load("scenarios", name)(**given)
    found = scenario.acceptance(_run(scenario))
    assert len(found) == count
    for one in found:
        assert one.fulfilled, one


def test_criteria() -> None:
    """Bounds belong to the range; what is no number fulfils nothing; no range, no name and no source are refused."""
    assert Criterion("a", 1.0, 1.0, 2.0, "theory").fulfilled
    assert not Criterion("a", 0.999, 1.0, 2.0, "theory").fulfilled
    assert not Criterion("a", float("nan"), float("-inf"), 2.0, "theory").fulfilled
    near = Criterion.near("a", None, 3.0, 0.5, "theory")
    assert (near.lower, near.upper, near.fulfilled) == (2.5, 3.5, False)
    for wrong, told in (
        (("", 1.0, 0.0, 1.0, "theory"), "name must be given"),
        (("a", 1.0, 0.0, 1.0, " "), "source must be given"),
        (("a", 1.0, 2.0, 1.0, "theory"), "must have a range"),
        (("a", 1.0, float("-inf"), float("inf"), "theory"), "must have a bound"),
    ):
        with pytest.raises(ns.InvalidInput, match=told):
            Criterion(*wrong)
