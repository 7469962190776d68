"""Histories as datasets: every array has its unit, and every axis its names."""

from __future__ import annotations

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, BallJoint, Plate
from nonsmooth.histories.distances import distances
from nonsmooth.histories.variables import VARIABLES
from nonsmooth.plugins import registry


@pytest.mark.parametrize("times", [0.05, [0.0, 0.05, 0.1]])
def test_every_history_makes_a_dataset_of_its_own_arrays(times: float | list[float]) -> None:
    ball, base = Ball(0.01), Plate()
    system = ns.System([ball, base])
    system.name(ball, "bob")
    system.place(ball, position=(0.1, 0.0, 0.3))
    system.joint(BallJoint(first=(0.0, 0.0, 0.3), second=(-0.1, 0.0, 0.0)), base, ball, name="pivot")
    solution = ns.simulate(system, 0.1)
    joints = [name for name in VARIABLES if name.startswith("joint")]
    histories = (
        solution.at(times),
        solution.history("position", "rotation", times=times, of=ball),
        solution.history(*joints, times=times),
        solution.history("kinetic_energy", "loss", times=times),
        distances(solution, ball, base, times),
    )
    for history in histories:
        data = history.to_xarray()
        np.testing.assert_array_equal(np.atleast_1d(data["time"]), np.atleast_1d(times))
        for name, variable in data.data_vars.items():
            np.testing.assert_array_equal(variable, history[str(name)])
            # inner states of laws have units that only the law knows
            along = f"{variable.dims[-1]}_units" if variable.dims else ""
            assert variable.attrs.get("units") or along in data.coords or variable.dims[-1] == "law_state"
            assert variable.attrs["long_name"]
            assert {*variable.dims} <= {*data.coords, "law_state"}
    states, forces = histories[0].to_xarray(), histories[2].to_xarray()
    assert states["q"].sel(coordinate="bob z").dims == ("time",)[: np.ndim(times)]
    assert states["coordinate_units"].sel(coordinate="bob q0") == "1"
    assert forces["joint"].values.tolist() == ["pivot"]
    np.testing.assert_allclose(forces["joint_force"].sel(joint="pivot", axis="y"), 0.0, atol=1e-12)


def test_a_mechanism_says_its_units() -> None:
    data = ns.simulate(registry.load("scenarios", "woodpecker")().build(), 1e-3).at().to_xarray()
    assert data["coordinate_units"].values.tolist() == ["m", "rad", "rad"]
    assert data["velocity_units"].values.tolist() == ["m/s", "rad/s", "rad/s"]
