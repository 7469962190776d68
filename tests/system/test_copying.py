"""A system that was pickled or copied is one like the first, of bodies of its own."""

from __future__ import annotations

import copy
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, Plate
from laws import Coulomb
from nonsmooth.engine.memory import owners
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.model.assembly import assemble
from nonsmooth.plugins import registry


def _pickled(system: Any) -> Any:
    return pickle.loads(pickle.dumps(system))


COPIES: tuple[Callable[[Any], Any], ...] = (_pickled, copy.deepcopy, copy.copy)


@pytest.fixture
def system(build: Any) -> ns.System:
    system: ns.System = build.over(Ball(0.01))
    system.place(system.bodies[1], position=(0.0, 0.0, 0.02))
    return system


@pytest.mark.parametrize("copied", COPIES)
def test_a_copy_can_do_what_a_system_can(system: ns.System, copied: Any, tmp_path: Path) -> None:
    """It runs to the same numbers; its bodies can be placed, its laws changed, and it can be written to a file."""
    one, other = ns.simulate(system, 0.07), ns.simulate(copied(system), 0.07)
    np.testing.assert_array_equal(one.q, other.q)
    made = copied(system)
    plate, ball = made.bodies
    with pytest.raises(ns.InvalidInput, match="no contact with each other yet"):
        made.contact(plate, ball, **vars(made.declarations[0].laws))
    assert made.contact_all(ns.Materials(default=made.declarations[0].laws)) == ()
    ns.touching(made, ball, position=(0.1, 0.0, 1.0))
    assert made.start(ball)[0][2] == pytest.approx(0.01, abs=1e-15)
    assert ns.with_laws(made, friction=Coulomb(0.2)).contacts[0].friction == Coulomb(0.2)
    ns.save_system(made, tmp_path / "made.toml")
    read = ns.load_system(tmp_path / "made.toml").system
    np.testing.assert_array_equal(read.start(read.bodies[1])[0], made.start(ball)[0])


@pytest.mark.parametrize("copied", COPIES)
def test_what_is_done_to_a_copy_leaves_the_first_alone(system: ns.System, copied: Any) -> None:
    """Starts and further contacts of one are not those of the other."""
    laws = vars(system.declarations[0].laws)
    third = ns.System([*system.bodies, Ball(0.02)])
    made = copied(third)
    made.place(made.bodies[1], position=(0.0, 0.0, 5.0))
    made.contact(*made.bodies[1:], **laws)
    assert third.start(third.bodies[1])[0][2] == 0.0
    assert third.contacts == ()
    third.contact(*third.bodies[1:], **laws)


def test_bodies_of_the_first_are_strangers_to_a_copy_with_its_own(system: ns.System) -> None:
    """They are told apart as objects, also where an old object's place in memory may be taken again."""
    made = _pickled(system)
    for stranger in (system.bodies[1], Plate()):
        with pytest.raises(ns.InvalidInput, match="body of this system"):
            made.start(stranger)
        with pytest.raises(ns.InvalidInput, match="body of this system"):
            made.place(stranger)


def test_the_system_of_a_pickled_solution_runs_on(system: ns.System) -> None:
    """What comes back from another process can be started again where it ended."""
    back = _pickled(ns.simulate(system, 0.05))
    body = back.system.bodies[1]
    back.system.set_start(body, back.q_end, back.u_end)
    assert ns.simulate(back.system, 0.05).status == "done"


@pytest.mark.fast_cases(16)
@pytest.mark.parametrize("name", registry.names("scenarios"))
def test_every_scenario_can_be_sent_to_another_process(name: str) -> None:
    """Its system comes out of the pickle with the same starts, and lies in the engine with the same gaps."""
    system = registry.load("scenarios", name)().build()
    one, other = (assemble(made, EventDriven()) for made in (system, _pickled(system)))
    np.testing.assert_array_equal(one.memory[owners.Island.y][: one.n_y], other.memory[owners.Island.y][: other.n_y])
    np.testing.assert_array_equal(one.gaps(), other.gaps())
    assert one.energy() == other.energy()
