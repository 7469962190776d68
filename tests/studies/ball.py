"""What the tests run: a ball dropped on a plate, and functions that misbehave; importable by other processes."""

from __future__ import annotations

import hashlib
import os
import time
from typing import Any

import numpy as np

import nonsmooth as ns
from bodies import Ball, Plate, Rest
from laws import EnergeticImpact, Frictionless, Unilateral
from nonsmooth import studies

T_END = 0.3
RECORD = ("q_end", "u_end", "impacts", "steps", "energy_residual")


def drop(height: float, restitution: float = 0.7) -> ns.System:
    """Return a ball above a plate; without a height there is none."""
    if height < 0.0:
        raise ArithmeticError(f"no ball at {height}")
    plate, ball = Plate(Rest()), Ball(0.01, 7800.0)
    system = ns.System([plate, ball])
    system.contact(ball, plate, normal=Unilateral(), friction=Frictionless(), impact=EnergeticImpact(restitution))
    system.place(ball, position=(0.0, 0.0, 0.01 + height))
    return system


def shaken(seed: int) -> ns.System:
    """Return a ball at a height that a seed decides."""
    return drop(np.random.default_rng(seed).uniform(0.01, 0.05))


def slow(height: float) -> ns.System:
    """Take a while."""
    time.sleep(0.03)
    return drop(height)


def deadly(height: float) -> ns.System:
    """Kill the process at one height, after a while."""
    if height == 0.05:
        time.sleep(0.5)
        os._exit(9)
    return drop(height)


def draws(n: int = 24) -> studies.Sampling:
    """Return starts."""
    return studies.random(n, 3, height=(0.01, 0.1), restitution=(0.4, 0.9))


def study(n: int = 24) -> studies.Study:
    """Return a study of drops."""
    return studies.Study(drop, draws(n), RECORD, t_end=T_END)


def slow_study() -> studies.Study:
    """Return one that takes some seconds."""
    return studies.Study(slow, studies.grid(height=np.linspace(0.01, 0.1, 60)), RECORD, t_end=T_END)


def digest(dataset: Any) -> str:
    """Return the sha256 of all arrays."""
    found = hashlib.sha256()
    for name in sorted(map(str, dataset.variables)):
        values = dataset[name].values
        found.update(f"{name} {values.dtype} {values.shape}".encode() + np.ascontiguousarray(values).tobytes())
    return found.hexdigest()
