"""Implicit steps of the flow: the order of what they interpolate, and samples of a motion that begins with one."""

from __future__ import annotations

import math

import numpy as np

import nonsmooth as ns
from bodies import Plate, Rod
from laws import Coulomb, NewtonImpact, Unilateral
from nonsmooth.engine.memory import implicit_tableau as pair


def test_the_interpolant_is_of_fourth_order() -> None:
    """On every tree of four nodes the bend is that of the quartic; on smaller ones, where the cubic is exact, none."""
    nodes, bend = np.array(pair.NODES), np.array(pair.BEND)
    stages = np.zeros((7, 7))
    stages[:, :6] = pair.STAGES
    stages[range(2, 7), range(2, 7)] = pair.DIAGONAL
    for power, exact in ((0, 0.0), (1, 0.0), (2, 0.0), (3, 1.0 / 4.0)):
        assert abs(bend @ nodes**power - exact) < 1e-14
    assert abs(bend @ stages @ nodes - 0.0) < 1e-14
    assert abs(bend @ (nodes * (stages @ nodes)) - 1.0 / 8.0) < 1e-14
    assert abs(bend @ stages @ nodes**2 - 1.0 / 12.0) < 1e-14
    assert abs(bend @ stages @ stages @ nodes - 1.0 / 24.0) < 1e-14


def test_the_predictor_is_the_explicit_half_of_the_pair() -> None:
    """With the weights of the implicit one it is of fourth order on every tree, and its nodes are the same."""
    nodes, explicit = np.array(pair.NODES), np.zeros((7, 7))
    explicit[:, :6] = pair.PREDICTOR
    weights = np.append(pair.STAGES[6], pair.DIAGONAL)
    np.testing.assert_allclose(explicit.sum(axis=1), nodes, rtol=0, atol=1e-12)
    assert abs(weights @ explicit @ nodes - 1.0 / 6.0) < 1e-12
    assert abs(weights @ (nodes * (explicit @ nodes)) - 1.0 / 8.0) < 1e-12
    assert abs(weights @ explicit @ nodes**2 - 1.0 / 12.0) < 1e-12
    assert abs(weights @ explicit @ explicit @ nodes - 1.0 / 24.0) < 1e-12


def test_samples_of_a_slip_that_starts_from_rest_are_as_good_as_its_steps() -> None:
    """A rod tips over its lower end, which slips: its orientation stays of unit length between the steps, too."""
    plate, rod = Plate(), Rod(0.03, 0.003)
    system = ns.System([plate, rod], 9.81)
    system.contact(plate, rod, normal=Unilateral(), friction=Coulomb(0.3), impact=NewtonImpact(0.0))
    ns.resting(system, rod, position=(0.0, 0.0, 0.05), orientation=(math.cos(0.5), 0.0, math.sin(0.5), 0.0))
    solution = ns.simulate(system, 0.05, sample_interval=1e-4)
    assert abs(np.linalg.norm(solution.q[:, 3:7], axis=1) - 1.0).max() < 5e-10
