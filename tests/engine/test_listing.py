"""The list of near contacts: nothing that is nearer than its margin is left out, and walls far away are."""

from __future__ import annotations

import numpy as np
import pytest

from bodies import Ball, BoxBody, ConstantVelocity, DrivenBody, Plate, Rest, TriangleMesh, Triangles
from laws import Bristle, Coulomb, Directional, EnergeticImpact, LinearCompliant, RateAndState, Unilateral
from nonsmooth import ContactLaws, System, simulate
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.declare import Life, declarations
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.interfaces import Motion
from nonsmooth.model.assembly import assemble, lay_out
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.declared import DeclaredContacts
from nonsmooth.model.laid_out import LaidOut
from tests.bodies.meshes.parts import hills

RADIUS, WIDTH = 0.01, 0.2
NORMAL, FRICTION, IMPACT = Unilateral(), Coulomb(0.3), EnergeticImpact(0.8)
TURN = 0.5**0.5
UPSIDE_DOWN = (0.0, 1.0, 0.0, 0.0)


def _system(places: np.ndarray, floor: Motion) -> tuple[System, list[Ball]]:
    """Return balls over a floor, below a ceiling and beside a wall, all in contact with all."""
    wall = Plate(Rest(position=(-0.5 * WIDTH, 0.0, 0.0), orientation=(TURN, 0.0, TURN, 0.0)))
    plates = [Plate(floor), Plate(Rest(position=(0.0, 0.0, WIDTH), orientation=UPSIDE_DOWN)), wall]
    balls = [Ball(RADIUS, 2500.0) for _ in places]
    system = System([*plates, *balls], gravity=9.81)
    for i, ball in enumerate(balls):
        for other in (*plates, *balls[:i]):
            system.contact(other, ball, normal=NORMAL, friction=FRICTION, impact=IMPACT)
    for ball, place in zip(balls, places, strict=True):
        system.place(ball, position=tuple(place))
    return system, balls


def _gaps(system: System, places: np.ndarray) -> np.ndarray:
    """Return the gaps of all declared contacts, in order."""
    gaps = []
    for i, place in enumerate(places):
        gaps += [place[2] - RADIUS, WIDTH - place[2] - RADIUS, place[0] + 0.5 * WIDTH - RADIUS]
        gaps += [float(np.linalg.norm(place - other)) - 2.0 * RADIUS for other in places[:i]]
    assert len(gaps) == len(system.contacts)
    return np.array(gaps)


def _listed(model: LaidOut) -> np.ndarray:
    n = int(model.memory[owners.Island.n_contacts])
    listed = np.zeros(len(model.system.contacts), bool)
    listed[model.memory[owners.ContactRecord.declared][:n]] = True
    return listed


@pytest.mark.parametrize("seed", range(4))
def test_what_is_near_is_listed(seed: int) -> None:
    """All contacts nearer than the margin have a slot, of walls at rest no others."""
    random = np.random.default_rng(seed)
    cells = random.permutation(125)[:40]
    places = (np.array(np.unravel_index(cells, (5, 5, 5))).T + 0.5) * 0.04 - [0.1, 0.1, 0.0]
    places += random.uniform(-0.0099, 0.0099, places.shape)
    system, _ = _system(places, Rest())
    model = assemble(system, EventDriven())
    gaps, listed = _gaps(system, places), _listed(model)
    margin = float(model.memory[owners.Island.list_margin])
    assert np.all(listed[gaps < margin])
    walls = np.array([isinstance(contact.first, Plate) for contact in system.contacts])
    assert not np.any(listed[walls & (gaps > margin)])
    assert 0 < np.count_nonzero(listed[walls]) < np.count_nonzero(walls)


def test_a_wall_that_moves_is_always_listed() -> None:
    """Nothing tells of it when it has come near."""
    places = np.array([[0.03 * i - 0.08, 0.03 * j, 0.1] for i in range(4) for j in range(4)])
    system, _ = _system(places, ConstantVelocity(velocity=(0.0, 0.0, 0.5)))
    model = assemble(system, EventDriven())
    moving = np.array([contact.first is system.bodies[0] for contact in system.contacts])
    assert np.all(_listed(model)[moving])


_OF_DECLARED = [
    one
    for one in declarations(owners.ContactRecord).values()
    if one.life is Life.PARAMETER and not one.is_of_slot and not one.inside[0]
]
"""Parameters that an active contact copies from its declared contact."""


def _check_parameters(model: LaidOut) -> None:
    """Check that all active contacts have the parameters of their declared contacts."""
    active = model.active
    declared = DeclaredContacts.of(model.memory, active)
    for one in _OF_DECLARED:
        np.testing.assert_array_equal(model.memory[one][: len(active)], declared[one], err_msg=one.name)


@pytest.mark.parametrize(
    "laws",
    [
        ContactLaws(NORMAL, FRICTION, IMPACT),
        ContactLaws(NORMAL, RateAndState(0.3, direct=0.01, evolution=0.02, reference_speed=1e-6, length=1e-5), IMPACT),
        ContactLaws(NORMAL, Directional(0.4, 0.3, 0.2, axis=(1.0, 0.0, 0.0), body="first"), IMPACT),
        ContactLaws(LinearCompliant(1e5), Bristle(0.3, 0.4)),
    ],
    ids=lambda laws: type(laws.friction).__name__,
)
def test_active_contacts_have_the_parameters_of_declared_ones(laws: ContactLaws) -> None:
    """Contacts of a row, of several rows with the same kinds, and of rows with features that a search finds.

    The list is made by the engine, then brought by a checkpoint, which holds no parameters.
    """
    ground = DrivenBody(carried=(TriangleMesh(Triangles(*hills(6))),))
    bodies = [ground, *(Ball(0.03, 1000.0) for _ in range(3)), *(BoxBody(0.03, 0.03, 0.03, mass=0.1) for _ in range(2))]
    system = System(bodies)
    for i, body in enumerate(bodies[1:]):
        system.place(body, position=(0.07 * (i - 2), 0.0, 0.05))
    system.contact_all(laws)
    model = lay_out(system, EventDriven())
    active = model.active.copy()
    assert np.any(model.memory[owners.ContactRecord.features][: len(active)] > 0)
    _check_parameters(model)
    checkpoint = Checkpoint.of(model.memory)
    for one in _OF_DECLARED:
        model.memory[one][:] = 0
    model.memory[owners.ContactRecord.declared][: len(active)] = active[::-1]
    checkpoint.put(model.memory)
    np.testing.assert_array_equal(model.active, active)
    _check_parameters(model)


@pytest.mark.parametrize("speed", [0.0, 0.4])
def test_balls_that_never_meet_bounce_as_each_would_alone(speed: float) -> None:
    """Between floor and ceiling, with a list of contacts and without, whether the floor moves or not."""
    n, t_end = 12, 0.4
    places = np.array([[0.04 * i - 0.05, 0.0, 0.03 + 0.012 * i] for i in range(n)])
    floor = ConstantVelocity(velocity=(0.0, 0.0, speed)) if speed > 0.0 else Rest()
    ways = np.array([[0.0, 0.1 * i, 1.5 - 0.3 * i] for i in range(n)])
    places[:, 0] *= 2.0
    places[:, 0] += 0.1
    spins = np.array([[3.0 * i, -20.0, 5.0 * i] for i in range(n)])
    ends = []
    for some in ([*range(n)], *([i] for i in range(n))):
        system, balls = _system(places[some], floor)
        assert (len(some) == 1) == (len(system.contacts) <= 64)
        for ball, i in zip(balls, some, strict=True):
            system.place(ball, position=tuple(places[i]), velocity=tuple(ways[i]), angular_velocity=tuple(spins[i]))
        solution = simulate(system, t_end, sample_interval=t_end)
        assert solution.counters.impacts >= len(some)
        ends.append((solution.q_end, solution.u_end))
    together, alone = ends[0], ends[1:]
    np.testing.assert_allclose(together[0], np.concatenate([q for q, _ in alone]), rtol=0, atol=1e-8)
    np.testing.assert_allclose(together[1], np.concatenate([u for _, u in alone]), rtol=0, atol=1e-6)
