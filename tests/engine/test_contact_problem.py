"""The contact problem on random matrices: every answer fulfils the laws themselves."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.linalg import null_space
from scipy.optimize import linprog

from laws import Coulomb, Unilateral
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory, allocate
from nonsmooth.engine.memory.modes import Mode
from nonsmooth.engine.memory.solvers import Solver
from nonsmooth.engine.memory.tables import COUNTS
from nonsmooth.engine.native.kernel import call_entry, entry_addresses
from nonsmooth.problems.matrices import write_delassus
from tests.benchmarks.solvers import FRICTION, bodies, lay_out


def _memory(delassus: Any, bias: Any, mu: Any, static: Any, slip: Any) -> Memory:
    """Lay out one contact problem; ``slip`` holds unit vectors of sliding contacts, zeros at rest."""
    n = len(mu)
    memory = allocate(dict.fromkeys(COUNTS, 0) | {"n_slots": n})
    memory[owners.ModelNumbers.entry_points][: len(entry_addresses())] = entry_addresses()
    memory[owners.Problem.n_active] = n
    memory[owners.Problem.active][:n] = np.arange(n)
    write_delassus(memory, np.asarray(delassus))
    memory[owners.Problem.free_accelerations][: 3 * n] = np.ravel(bias)
    memory[owners.ActiveContact.friction_coefficient][:n] = mu
    memory[owners.ActiveContact.static_coefficient][:n] = static
    rest = np.all(np.asarray(slip) == 0.0, axis=1)
    memory[owners.ActiveContact.is_at_rest][:n] = rest
    for owner in (owners.ActiveContact, owners.ContactRecord):
        memory[owner.direction][:n] = np.where(rest[:, None], [1.0, 0.0], slip)
    memory[owners.ActiveContact.mode_tried][:n] = np.where(rest, Mode.STICK, Mode.SLIDE)
    return memory


def _solve(memory: Memory, n: int) -> tuple[bool, Any, Any]:
    """Return whether it was solved, forces and modes."""
    found = call_entry("solve_contact", memory) == 1
    return found, memory[owners.ActiveContact.force][:n].copy(), memory[owners.ActiveContact.mode_tried][:n].copy()


def _delassus(seed: int, n: int, freedoms: int) -> tuple[Any, Any]:
    random = np.random.default_rng(seed)
    jacobian = random.normal(size=(3 * n, freedoms))
    return jacobian @ jacobian.T, random.normal(size=(n, 3)) * [3.0, 1.0, 1.0]


def _assert_lawful(delassus: Any, bias: Any, forces: Any, modes: Any, mu: Any, static: Any, slip: Any) -> None:
    acceleration = (delassus @ forces.ravel()).reshape(-1, 3) + bias
    size = max(1.0, float(np.max(np.abs(forces))), float(np.max(np.abs(delassus))) * float(np.max(np.abs(forces))))
    small = 1e-8 * size
    for i in range(len(mu)):
        normal, pull, push = forces[i, 0], forces[i, 1:], acceleration[i, 1:]
        assert Unilateral().is_fulfilled(acceleration[i, 0], normal, small)
        law = Coulomb(float(mu[i]), float(static[i]))
        if np.any(slip[i] != 0.0):
            assert modes[i] != Mode.STICK
            assert law.is_fulfilled(tuple(slip[i]), normal, tuple(pull), small)
        elif modes[i] == Mode.STICK:
            np.testing.assert_allclose(push, 0.0, rtol=0, atol=small)
            assert np.hypot(*pull) <= static[i] * normal + small
        elif modes[i] == Mode.SLIDE and np.hypot(*push) > 1e-6 * size:
            np.testing.assert_allclose(pull, -mu[i] * normal * push / np.hypot(*push), rtol=0, atol=1e-6 * size)
        elif modes[i] == Mode.OPEN:
            assert normal == 0.0


coefficients = st.lists(st.floats(0.05, 0.7), min_size=4, max_size=4)


@settings(max_examples=150)
@given(seed=st.integers(0, 10**6), n=st.integers(1, 4), mu=coefficients, extra=st.sampled_from([1.0, 1.3]))
def test_contacts_at_rest(seed: int, n: int, mu: Any, extra: float) -> None:
    """Incipient slip: every positive definite G has a solution, and it is found, on the cone, not a pyramid."""
    delassus, bias = _delassus(seed, n, 3 * n + 2)
    mu, slip = np.array(mu[:n]), np.zeros((n, 2))
    static = mu * extra
    found, forces, modes = _solve(_memory(delassus, bias, mu, static, slip), n)
    # with mu_s > mu there may be none
    assert found or extra > 1.0
    if found:
        _assert_lawful(delassus, bias, forces, modes, mu, static, slip)


@settings(max_examples=100)
@given(
    seed=st.integers(0, 10**6),
    n=st.integers(1, 4),
    mu=coefficients,
    sliding=st.lists(st.booleans(), min_size=4, max_size=4),
)
def test_some_slide(seed: int, n: int, mu: Any, sliding: Any) -> None:
    """Whatever is accepted among sliding and resting contacts obeys Eqs. (16) and (17)."""
    delassus, bias = _delassus(seed, n, 3 * n + 2)
    random = np.random.default_rng(seed + 1)
    angles = random.uniform(0.0, 2.0 * math.pi, n)
    slip = np.column_stack([np.cos(angles), np.sin(angles)]) * np.array(sliding[:n])[:, None]
    mu = np.array(mu[:n]) * 0.3
    found, forces, modes = _solve(_memory(delassus, bias, mu, mu, slip), n)
    if found:
        _assert_lawful(delassus, bias, forces, modes, mu, mu, slip)
    else:
        reduced = [delassus[3 * i, 3 * i] - mu[i] * slip[i] @ delassus[3 * i, 3 * i + 1 : 3 * i + 3] for i in range(n)]
        assert n > 1 or min(reduced) <= 0.0


@settings(max_examples=60)
@given(seed=st.integers(0, 10**6), n=st.integers(2, 4), mu=coefficients)
def test_rank_deficient(seed: int, n: int, mu: Any) -> None:
    """More contacts than the body has freedoms: the accelerations are lawful though the forces are not unique."""
    delassus, bias = _delassus(seed, n, 6)
    random = np.random.default_rng(seed)
    jacobian = random.normal(size=(3 * n, 6))
    bias = (jacobian @ random.normal(size=6)).reshape(n, 3)
    mu = np.array(mu[:n])
    slip = np.zeros((n, 2))
    found, forces, modes = _solve(_memory(delassus, bias, mu, mu, slip), n)
    assume(found)
    _assert_lawful(delassus, bias, forces, modes, mu, mu, slip)


@settings(max_examples=40)
@given(seed=st.integers(0, 10**6), mu=coefficients, shift=st.integers(1, 2))
def test_order_of_contacts_does_not_matter(seed: int, mu: Any, shift: int) -> None:
    """Permuting three contacts permutes the forces."""
    n = 3
    delassus, bias = _delassus(seed, n, 11)
    mu = np.array(mu[:n])
    order = np.roll(np.arange(n), shift)
    rows = (3 * order[:, None] + np.arange(3)).ravel()
    slip = np.zeros((n, 2))
    one = _solve(_memory(delassus, bias, mu, mu, slip), n)
    other = _solve(_memory(delassus[np.ix_(rows, rows)], bias[order], mu[order], mu[order], slip), n)
    assert one[0]
    assert other[0]
    np.testing.assert_allclose(other[1], one[1][order], rtol=0, atol=1e-7 * max(1.0, np.max(np.abs(one[1]))))


@pytest.mark.parametrize("side", [-1e-6, 1e-6])
@pytest.mark.parametrize("static", [0.3, 0.5])
def test_breakaway_of_one_contact(side: float, static: float) -> None:
    """A block on a plane: it sticks iff the pull is at most mu_s times the weight, and slips with mu."""
    mu, pull = 0.3, static * (1.0 + side)
    bias = np.array([[-1.0, 0.6 * pull, 0.8 * pull]])
    found, forces, modes = _solve(_memory(np.eye(3), bias, [mu], [static], np.zeros((1, 2))), 1)
    assert found
    assert modes[0] == (Mode.STICK if side < 0.0 else Mode.SLIDE)
    size = pull if side < 0.0 else mu
    np.testing.assert_allclose(forces[0], (1.0, -0.6 * size, -0.8 * size), rtol=0, atol=1e-12)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_breakaway_where_normal_and_tangent_are_coupled(side: float) -> None:
    """Sticking needs 1.002 of the static bound here, and sliding changes the normal force: it slides, one way only."""
    delassus = np.array([[228.454549, -90.392349, -19.640517], [-90.392349, 217.275552, -79.72869], [0.0, 0.0, 0.0]])
    delassus[2] = -19.640517, -79.72869, 566.890631
    bias = np.array([[-13.597983, 2.144279, 0.472366]])
    mu, static = 0.2, 0.300600 + side * 1e-3
    found, forces, modes = _solve(_memory(delassus, bias, [mu], [static], np.zeros((1, 2))), 1)
    assert found
    assert modes[0] == (Mode.SLIDE if side < 0.0 else Mode.STICK)
    acceleration = delassus @ forces[0] + bias[0]
    assert abs(acceleration[0]) <= 1e-12
    friction = forces[0, 1:]
    if side > 0.0:
        np.testing.assert_allclose(acceleration, 0.0, atol=1e-12)
        assert np.hypot(*friction) <= static * forces[0, 0]
    else:
        assert np.hypot(*friction) == pytest.approx(mu * forces[0, 0], rel=1e-12)
        slip = acceleration[1:]
        assert friction @ slip == pytest.approx(-np.hypot(*friction) * np.hypot(*slip), rel=1e-12)


@pytest.mark.parametrize("side", [-1e-9, 1e-9])
def test_lift_off_of_one_contact(side: float) -> None:
    """The contact opens iff the free acceleration points away."""
    bias = np.array([[side, 0.4, -0.2]])
    found, forces, modes = _solve(_memory(np.eye(3), bias, [0.3], [0.3], np.zeros((1, 2))), 1)
    assert found
    assert (modes[0] == Mode.OPEN) == (side > 0.0)
    assert forces[0, 0] == pytest.approx(max(0.0, -side), abs=1e-15)


PAINLEVE = np.array([[1.0, -2.0, 0.0], [-2.0, 5.0, 0.0], [0.0, 0.0, 1.0]])
SLIDING = np.array([[-1.0, 0.0]])


@pytest.mark.parametrize("side", [-1e-6, 1e-6])
def test_painleve_without_solution(side: float) -> None:
    """Reduced normal coefficient g_nn - mu g_nt at its zero, pressed in: solved below mu = 1/2, unsolvable above."""
    mu = 0.5 * (1.0 + side)
    # sliding along -t1: friction +mu acts through g_nt = -2, so the reduced coefficient is 1 - 2 mu
    found, forces, _ = _solve(_memory(PAINLEVE, [[-1.0, 0.0, 0.0]], [mu], [mu], SLIDING), 1)
    assert found == (side < 0.0)
    if found:
        assert forces[0, 0] == pytest.approx(1.0 / (1.0 - 2.0 * mu), rel=1e-8)


@pytest.mark.parametrize("past", [Mode.SLIDE, Mode.OPEN])
def test_painleve_with_two_solutions_takes_the_stable_one(past: int) -> None:
    """Pulled apart with a negative coefficient both contact and flight are solutions, but sliding is unstable.

    On a spring, however stiff, a little more force would give more approach and still more force.
    """
    memory = _memory(PAINLEVE, [[1.0, 0.0, 0.0]], [0.8], [0.8], SLIDING)
    memory[owners.ActiveContact.mode_tried][0] = past
    found, forces, modes = _solve(memory, 1)
    assert found
    assert modes[0] == Mode.OPEN
    assert forces[0, 0] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("decades", [8, 14, 20])
def test_directions_are_found_beside_contacts_with_next_to_no_force(decades: int) -> None:
    """Normal forces so many decades apart: friction is along the acceleration of each slip that starts, soon."""
    n = 8
    for seed in range(50):
        random = np.random.default_rng(seed)
        problem = bodies(n, random)
        normal = np.append(1.0, 10.0 ** random.uniform(-decades, 0.0, n - 1))
        memory = lay_out(problem, Solver.AUTO)
        memory[owners.ActiveContact.has_given_force][:n] = 1
        memory[owners.ActiveContact.given_force][:n] = normal
        memory[owners.ActiveContact.mode_tried][:n] = Mode.SLIDE
        forces = memory[owners.ActiveContact.force][:n]
        forces[:, 0] = normal
        slip = (problem.delassus @ forces.ravel() + problem.bias).reshape(n, 3)[:, 1:]
        directions = slip / np.hypot(slip[:, 0], slip[:, 1])[:, None]
        memory[owners.ActiveContact.direction][:n] = directions
        assert call_entry("find_slip_directions", memory) == 1
        assert memory[owners.Totals.n_evaluations] <= 10
        slip = (problem.delassus @ forces.ravel() + problem.bias).reshape(n, 3)[:, 1:]
        pull = forces[:, 1:] / normal[:, None]
        assert np.hypot(pull[:, 0], pull[:, 1]) == pytest.approx(FRICTION)
        across = pull[:, 0] * slip[:, 1] - pull[:, 1] * slip[:, 0]
        assert across == pytest.approx(0.0, abs=1e-12 * np.max(np.abs(problem.bias)))


@pytest.mark.parametrize("n", [2, 3, 5])
@pytest.mark.parametrize("decades", [1.0, 3.0])
@pytest.mark.parametrize("side", [-1e-3, 1e-3])
def test_contacts_stick_by_redundant_friction_if_any_of_its_distributions_holds_them(
    n: int, decades: float, side: float
) -> None:
    """Friction is redundant.  The least coefficient that holds all contacts is that of a linear program."""
    for seed in range(10):
        random = np.random.default_rng(100 * n + seed)
        jacobian, push = random.normal(size=(3 * n, 3)), random.normal(size=3)
        delassus, normal = jacobian @ jacobian.T, 10.0 ** random.uniform(-decades, decades, n)
        along = np.arange(3 * n) % 3 > 0
        sought = -(jacobian @ push + delassus[:, ~along] @ normal)[along]
        start = np.linalg.lstsq(delassus[np.ix_(along, along)], sought, rcond=1e-9)[0]
        null = null_space(delassus[np.ix_(along, along)], rcond=1e-9)
        least = _least_coefficient(start, null, normal)
        mu = np.full(n, least * (1.0 + side))
        memory = _memory(delassus, (jacobian @ push).reshape(n, 3), mu, mu, np.zeros((n, 2)))
        memory[owners.ActiveContact.has_given_force][:n] = 1
        memory[owners.ActiveContact.given_force][:n] = normal
        assert call_entry("verify", memory, False) == (side > 0.0)


def _least_coefficient(start: Any, null: Any, normal: Any) -> float:
    """Return the least coefficient of friction at which some friction ``start + null z`` is within its bounds.

    Discs are polygons of 360 sides, which are right to 4e-5.
    """
    angles = np.linspace(0.0, 2.0 * math.pi, 360, endpoint=False)
    sides = np.column_stack([np.cos(angles), np.sin(angles)])
    n, m = len(normal), null.shape[1]
    rows = np.vstack([np.column_stack([sides @ null[2 * i : 2 * i + 2], np.full(360, -normal[i])]) for i in range(n)])
    bounds = -np.concatenate([sides @ start[2 * i : 2 * i + 2] for i in range(n)])
    found = linprog(np.append(np.zeros(m), 1.0), A_ub=rows, b_ub=bounds, bounds=[(None, None)] * (m + 1))
    assert found.success
    return float(found.x[-1])
