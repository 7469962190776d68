"""A function that reads or writes beyond its block ends no process: it is named before the run, or at its end."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plate
from laws import Coulomb, LinearCompliant, NewtonImpact, Unilateral
from nonsmooth.binding import bounds
from nonsmooth.engine.memory.blocks import GUARD
from nonsmooth.interfaces import Load
from nonsmooth.parameters import parameter
from nonsmooth.system.contact import Contact
from tests.testing import (
    body_dummies,
    impact_dummies,
    joint_dummies,
    load_dummies,
    pair_dummies,
    stateful_dummies,
    traction_dummies,
)

RIGID: dict[str, Any] = {"normal": Unilateral(), "impact": NewtonImpact(0.5)}


@pytest.fixture(autouse=True)
def _untried(monkeypatch: pytest.MonkeyPatch) -> None:
    """Forget what other tests have tried: a function is tried with some sets of parameters only."""
    monkeypatch.setattr(bounds, "_tried", defaultdict(set))


def _landing(**laws: Any) -> ns.System:
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    system.contact(plate, ball, **laws)
    system.place(ball, position=(0.0, 0.0, 0.011), velocity=(0.1, 0.0, 0.0))
    return system


def _body() -> ns.System:
    return ns.System([body_dummies.Ball(body_dummies.BEYOND)])


def _load() -> ns.System:
    system = _landing(**RIGID, friction=Coulomb(0.2))
    system.load(load_dummies.Pull(load_dummies.BEYOND), *system.bodies)
    return system


def _joint() -> ns.System:
    system = _landing(**RIGID, friction=Coulomb(0.2))
    system.joint(joint_dummies.Point(joint_dummies.BEYOND), *system.bodies)
    return system


def _pair() -> ns.System:
    bodies = body_dummies.Ball(), body_dummies.Ball()
    system, kinematics = ns.System(bodies), pair_dummies.Pair.between(pair_dummies.FIRST, pair_dummies.SECOND)[-1]
    shapes, laws = (pair_dummies.FIRST, pair_dummies.SECOND), ns.ContactLaws(friction=Coulomb(0.2), **RIGID)
    system.add_contact(Contact.of_shapes(bodies, shapes, kinematics, laws, name="the contact"))
    return system


def _traction() -> ns.System:
    return _landing(normal=LinearCompliant(1e4, 1.0), friction=traction_dummies.Brush(traction_dummies.BEYOND))


def _rates() -> ns.System:
    return _landing(**RIGID, friction=stateful_dummies.Warm(change=stateful_dummies.beyond))


def _map() -> ns.System:
    return _landing(
        normal=Unilateral(), impact=impact_dummies.Map(function=impact_dummies.beyond), friction=Coulomb(0.2)
    )


CASES: dict[Callable[[], ns.System], tuple[str, int, bool]] = {
    _body: ("Ball", 111, True),
    _load: ("Pull", 9, True),
    _joint: ("Point", 42, True),
    _pair: ("contact 'the contact'", 31, True),
    _traction: ("Brush", 7, False),
    _rates: ("Warm", 1, False),
    _map: ("Map", 3, False),
}
"""Owner, length of the block, whether the start evaluates it, by what makes the system."""


@pytest.mark.fast_cases(1)
@pytest.mark.parametrize("make", CASES, ids=lambda make: make.__name__[1:])
def test_a_trial_names_who_writes_beyond(make: Callable[[], ns.System]) -> None:
    """Before anything compiled is called; again, and with the line."""
    owner, size, _ = CASES[make]
    for _ in range(2):
        with pytest.raises(ns.PluginError, match=rf"^{owner}.* reaches for number {size} of a block of {size}.*\(line"):
            ns.simulate(make(), 0.05)


@pytest.mark.parametrize("make", CASES, ids=lambda make: make.__name__[1:])
def test_guards_name_who_writes_beyond(make: Callable[[], ns.System], monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the trial missed it, the numbers behind the block tell: at the start, or at the end of the run."""
    monkeypatch.setattr(bounds, "_MOST", 0)
    _, size, at_start = CASES[make]
    with pytest.raises((ns.PluginError, ns.RunFailed), match=rf"has written past the {size} numbers of its") as caught:
        ns.simulate(make(), 0.05)
    assert isinstance(caught.value, ns.PluginError) == at_start


def _late(t: float, a: Any, b: Any, out: Any, where: float) -> None:
    """Write nothing, and later what is not asked for."""
    for i in range(9):
        out[i] = 0.0
    if t > 0.02:
        out[int(where)] = 1.0


@dataclass(frozen=True)
class Late(Load):
    """A load that writes past its block after a while."""

    where: float = parameter(9.0, doc="number of the place that is written to")

    @property
    def evaluator(self) -> Callable[..., None]:
        """The function."""
        return _late


@pytest.mark.parametrize("where", [8, 9, 9 + GUARD - 1])
def test_a_run_in_which_a_block_is_left_is_not_done(where: int) -> None:
    """What was computed is in the error; within the block nothing is said."""
    system = _landing(**RIGID, friction=Coulomb(0.2))
    system.load(Late(float(where)), *system.bodies)
    if where < 9:
        assert ns.simulate(system, 0.03).status == "done"
        return
    with pytest.raises(
        ns.RunFailed, match=rf"late plate - ball.*_late in .*test_bounds.py.* to out\[{where}\]"
    ) as caught:
        ns.simulate(system, 0.03)
    solution = caught.value.solution
    assert isinstance(solution, ns.Solution)
    assert solution.status == "failed"
    assert np.all(np.isfinite(solution.q))


def far(n: int, delassus: Any, rates: Any, out: Any, friction: Any, restitution: Any) -> None:
    """Write where no memory is."""
    out[10**9] = 1.0


def before(n: int, delassus: Any, rates: Any, out: Any, friction: Any, restitution: Any) -> None:
    """Write in front of the block, as if Python counted from its end."""
    out[-1] = 1.0


def reading(n: int, delassus: Any, rates: Any, out: Any, friction: Any, restitution: Any) -> None:
    """Read what is not given."""
    out[0] = rates[3 * n]


@pytest.mark.parametrize("function", [far, before, reading], ids=lambda f: f.__name__)
def test_machine_code_that_leaves_its_block_is_never_called(function: Callable[..., None]) -> None:
    """It would end the process, or read what is anybody's."""
    system = _landing(normal=Unilateral(), impact=impact_dummies.Map(function=function), friction=Coulomb(0.2))
    with pytest.raises(
        ns.PluginError, match=rf"^Map: {function.__name__} in .* reaches for number -?\d+ of a block of 3"
    ):
        ns.simulate(system, 0.05)
