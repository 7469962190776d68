"""A law that nobody has seen before: what is compiled for it, how long that takes, and that it moves as a built-in."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import pytest

import nonsmooth as ns
from laws import Coulomb
from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.plugins.file import load
from scenarios.dumbbell import DumbbellScenario

_TEXT = """
from dataclasses import dataclass
from nonsmooth.interfaces import FrictionLaw
from nonsmooth.parameters import parameter

def {name}(speed, friction):
    return friction + {number!r} * speed * 0.0

@dataclass(frozen=True)
class Law(FrictionLaw):
    friction: float = parameter(0.2, doc="coefficient")

    @property
    def coefficient(self):
        return {name}

    def is_fulfilled(self, slip, normal_force, tangential_force, tolerance):
        return True
"""


def _new(folder: Path, name: str) -> FrictionLaw:
    path = folder / f"{name}.py"
    path.write_text(_TEXT.format(name=name, number=time.time()))  # no cache has this number
    law: FrictionLaw = load("test", (FrictionLaw,), f"{path}:Law")()
    return law


def test_it_moves_the_dumbbell_as_the_built_in_that_it_copies(tmp_path: Path) -> None:
    system = DumbbellScenario(mode="drift").build()
    one = ns.simulate(ns.with_laws(system, friction=Coulomb(0.2)), 0.3)
    two = ns.simulate(ns.with_laws(system, friction=_new(tmp_path, "copied")), 0.3)
    assert one.q_end.tolist() == two.q_end.tolist()
    assert one.counters.steps == two.counters.steps


@pytest.mark.skipif(PLAIN, reason="nothing is compiled")
def test_it_is_compiled_alone(tmp_path: Path) -> None:
    from numba.core import event

    system = DumbbellScenario(mode="drift").build()
    ns.simulate(ns.with_laws(system, friction=_new(tmp_path, "before")), 0.01)  # the compiler warms up
    with event.install_recorder("numba:run_pass") as recorder:
        ns.simulate(ns.with_laws(system, friction=_new(tmp_path, "alone")), 0.01)
    passes: list[Any] = [e.data for _, e in recorder.buffer if e.is_start]
    compiled = {data["qualname"] for data in passes if "native_lowering" in data["name"]}
    assert compiled == {"alone", "shim"}
