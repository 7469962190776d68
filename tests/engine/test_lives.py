"""Numbers do not matter when their life has ended, and a checkpoint is all that a run needs to continue.

Each run is compared with the same run where all that is dead is poison, and with one between whose steps other runs
take steps in the same memory: equal to the last bit.
"""

from __future__ import annotations

import itertools

import numpy as np
import pytest

import nonsmooth as ns
from bodies import Ball, BallJoint, BoxBody, Harmonic, Plate, Spring
from laws import Coulomb, EnergeticImpact, HuntCrossley, Unilateral
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import Life, declarations
from nonsmooth.engine.memory.tables import OWNERS
from tests.benchmarks.lives import ENGINES, compared, digest
from tests.engine.life_engines import poison

RIGID = ns.ContactLaws(Unilateral(), Coulomb(0.3), EnergeticImpact(0.7))


def _pendulum_on_a_plate() -> tuple[ns.System, float]:
    """A joint, a spring, and a box that hits a plate and slides on it."""
    plate, box = Plate(), BoxBody(0.04, 0.03, 0.02)
    ball = Ball(0.015)
    system = ns.System([plate, box, ball])
    system.contact_all(RIGID)
    system.place(box, position=(0.0, 0.0, 0.03), velocity=(0.4, 0.1, -0.5))
    system.place(ball, position=(0.06, 0.0, 0.05), velocity=(0.4, 0.1, -0.5))
    system.joint(BallJoint((0.06, 0.0, 0.02), (0.0, 0.0, 0.0)), box, ball)
    system.load(Spring(20.0, 0.05), box, ball)
    return system, 0.15


def _shaken_balls() -> tuple[ns.System, float]:
    """Many impacts at once, a driven plate, and neighbours that change."""
    plate = Plate(motion=Harmonic(amplitude=1e-3, frequency=30.0))
    balls = [Ball(0.01) for _ in range(6)]
    system = ns.System([plate, *balls])
    system.contact_all(RIGID)
    for i, ball in enumerate(balls):
        system.place(
            ball, position=(0.0205 * (i % 3), 0.003 * (i // 3), 0.0101 + 0.021 * (i // 3)), velocity=(0.0, 0.0, -0.2)
        )
    return system, 0.1


def _compliant() -> tuple[ns.System, float]:
    """A law of force over indentation, on a plate that moves."""
    plate, ball = Plate(motion=Harmonic(amplitude=2e-3, frequency=15.0)), Ball(0.02)
    system = ns.System([plate, ball])
    system.contact(plate, ball, normal=HuntCrossley(1e6, 0.3), friction=Coulomb(0.2))
    system.place(ball, position=(0.0, 0.0, 0.03), velocity=(0.1, 0.0, 0.0))
    return system, 0.2


def _chain() -> tuple[ns.System, float]:
    """One impact of so many contacts that it is integrated in windows."""
    balls = [Ball(0.01) for _ in range(60)]
    system = ns.System(balls, gravity=0.0)
    for one, two in itertools.pairwise(balls):
        system.contact(one, two, normal=Unilateral(), friction=Coulomb(0.0), impact=EnergeticImpact(0.9))
    for i, ball in enumerate(balls):
        system.place(
            ball, position=(0.02 * i + (0.0 if i else -1e-3), 0.0, 0.0), velocity=(0.0 if i else 1.0, 0.0, 0.0)
        )
    return system, 3e-3


SYSTEMS = {
    "joint and spring": _pendulum_on_a_plate,
    "shaken balls": _shaken_balls,
    "compliant": _compliant,
    "large impact": _chain,
}


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("name", SYSTEMS)
def test_what_is_dead_does_not_matter(name: str, engine: str) -> None:
    system, t_end = SYSTEMS[name]()
    wanted = digest(system, t_end, ns.EventDriven())
    assert digest(SYSTEMS[name]()[0], t_end, ENGINES[engine]()) == wanted


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::nonsmooth.parameters.UnusualValue")
@pytest.mark.parametrize("engine", ENGINES)
# number 13 is refused where it is placed
@pytest.mark.parametrize("seed", [*range(13), *range(14, 16), *range(17, 20)])
def test_what_is_dead_does_not_matter_in_random_systems(seed: int, engine: str) -> None:
    assert compared(engine, seed)


def test_poison_reaches_every_number_of_its_life() -> None:
    """And no other."""
    memory = ns.assemble(_shaken_balls()[0])._laid.memory
    kept = {one: np.array(memory[one]) for owner in OWNERS for one in declarations(owner).values()}
    poison(memory, Life.STEP)
    assert np.isnan(memory[owners.Step.y_new]).all()
    for one, before in kept.items():
        if one.life is not Life.STEP:
            np.testing.assert_array_equal(memory[one], before, err_msg=one.key)


def test_a_run_in_one_memory_is_repeated_to_the_last_bit() -> None:
    """Nothing of a run is left for the next one but what a checkpoint does not hold."""
    system, t_end = _shaken_balls()
    model = ns.assemble(system)
    first, second = model.run(t_end), model.run(t_end)
    np.testing.assert_array_equal(first.q, second.q)
    np.testing.assert_array_equal(first.events.time, second.events.time)


def test_parameters_do_not_change_in_a_run() -> None:
    """What the table calls a parameter is the same before and after, but for what listed contacts take over."""
    system, t_end = _shaken_balls()
    model = ns.assemble(system)
    memory = model._laid.memory
    fixed = [
        one
        for owner in OWNERS
        for one in declarations(owner).values()
        if one.life is Life.PARAMETER and (owner is not owners.ContactRecord or one.is_of_slot)
    ]
    before = [np.array(memory[one]) for one in fixed]
    model.run(t_end)
    for one, numbers in zip(fixed, before, strict=True):
        np.testing.assert_array_equal(memory[one], numbers, err_msg=one.key)
