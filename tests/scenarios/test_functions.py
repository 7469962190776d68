"""A scenario out of a function is one like any other; parameters that must be integers."""

from __future__ import annotations

import inspect
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plate
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth import studies
from nonsmooth.parameters import parameter
from nonsmooth.testing import check_scenario


def _rolls(scenario: Any, solution: ns.Solution) -> tuple[ns.Criterion, ...]:
    speed = np.max(solution.u_end[::6])
    return (ns.Criterion.near("speed at the end [m/s]", speed, 5 / 7 * scenario.speed, 1e-6, "rolling"),)


@ns.scenario(title="Balls that stop slipping", t_end=0.5, acceptance=_rolls)
def sliding(
    speed: float = parameter(0.7, doc="speed at the start", unit="m/s", above=0.0),
    n_balls: int = parameter(1, doc="number of balls", minimum=1, integer=True),
) -> ns.System:
    """Balls slide on a floor until they roll."""
    floor, balls = Plate(), [Ball(radius=0.01) for _ in range(n_balls)]
    system = ns.System([floor, *balls])
    for place, ball in enumerate(balls):
        system.contact(ball, floor, normal=Unilateral(), friction=Coulomb(0.3), impact=EnergeticImpact(0.5))
        ns.touching(system, ball, position=(0.0, 0.1 * place, 1.0), velocity=(speed, 0.0, 0.0))
    return system


@pytest.mark.parametrize("prop", check_scenario(sliding(speed=1.4, n_balls=2)), ids=str)
def test_it_has_the_properties_of_a_scenario(prop: Any) -> None:
    prop()


def test_it_is_named_and_pickled_as_the_function() -> None:
    scenario = sliding(speed=1.4)
    assert pickle.loads(pickle.dumps(scenario)) == scenario
    assert repr(scenario) == "sliding(speed=1.4, n_balls=1, t_end=0.5)"
    assert str(inspect.signature(sliding)).startswith("(speed: 'float' = 0.7")
    assert "slide on a floor" in inspect.getsource(sliding)
    with pytest.raises(ns.InvalidInput, match=r"sliding\.speed must be > 0 \[m/s\]"):
        sliding(speed=-1.0)


def test_its_default_figure_is_the_coordinates_over_time() -> None:
    figure = sliding.gallery(ns.run_scenario)["coordinates"]
    assert [ax.get_ylabel() for ax in figure.axes][:3] == ["ball x [m]", "ball y [m]", "ball z [m]"]
    x = figure.axes[0].lines[0].get_ydata()
    assert x[-1] > x[0]


def test_it_is_studied(tmp_path: Path) -> None:
    study = studies.Study(sliding(), studies.grid(speed=[0.2, 0.4]), ["u_end"])
    found = study.run(tmp_path / "s.zarr")
    np.testing.assert_allclose(found.u_end[:, 0], [1 / 7, 2 / 7], atol=1e-6)


def test_arguments_must_be_declared() -> None:
    with pytest.raises(ns.InvalidInput, match=r"sliding: speed must be declared with parameter\(\)"):

        @ns.scenario(title="Undeclared", t_end=1.0, acceptance=_rolls)
        def sliding(speed: float = 1.0) -> ns.System:
            raise NotImplementedError


def test_an_integer_parameter_is_an_int_whatever_number_is_given() -> None:
    balls = sliding(n_balls=3.0)
    assert (balls.n_balls, type(balls.n_balls)) == (3, int)
    assert type(balls.varied(n_balls=2.0).n_balls) is int
    for wrong in (1.5, 0, float("nan"), True):
        with pytest.raises(ns.InvalidInput, match=r"sliding\.n_balls must be"):
            sliding(n_balls=wrong)
