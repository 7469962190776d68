"""Contacts that act on few others: structure and band grow with their number, and the answers are the dense ones."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bodies import Ball, Plate
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth import System
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory, allocate
from nonsmooth.engine.memory.modes import Mode, Status
from nonsmooth.engine.memory.tables import COUNTS
from nonsmooth.engine.native.kernel import call_entry, entry_addresses
from nonsmooth.engines.event_driven import EventDriven
from nonsmooth.model.assembly import assemble
from nonsmooth.problems.matrices import read_delassus, write_delassus

RADIUS = 0.01
TINY = 1e-300
"""Added to a matrix it leaves all but its zeros as they are: no block is left out then."""


def _row(n: int, order: Any, plate: bool) -> System:
    """Return a row of balls that touch, declared in some order, on a plate or in empty space."""
    balls = [Ball(RADIUS, 7780.0) for _ in range(n)]
    ground = Plate()
    system = System([*([ground] if plate else []), *(balls[i] for i in order)], gravity=9.81 if plate else 0.0)
    impact = EnergeticImpact(0.5)
    friction = Coulomb(0.3) if plate else Frictionless()
    for i in order:
        if plate:
            system.contact(balls[i], ground, normal=Unilateral(), friction=friction, impact=impact)
        if i + 1 < n:
            system.contact(balls[i], balls[i + 1], normal=Unilateral(), friction=friction, impact=impact)
    for i, ball in enumerate(balls):
        system.place(ball, position=(2.0 * RADIUS * i, 0.0, RADIUS))
    return system


def _started(system: System) -> Memory:
    memory = assemble(system, EventDriven()).memory
    call_entry("advance", memory, 0, 0)
    return memory


def _sizes(memory: Memory) -> tuple[int, int, int]:
    """Return the numbers of closed contacts, of stored blocks, and the half band of the last forces."""
    m = memory[owners.Island.n_grouped]
    return m, int(memory[owners.Island.block_start][m]), memory[owners.Problem.half_band]


@pytest.mark.parametrize("shuffled", [False, True])
def test_chain_costs_what_it_is_long(shuffled: bool) -> None:
    """Three blocks per contact and the same narrow band, in whatever order the balls were declared."""
    random = np.random.default_rng(3)
    for n in (8, 16, 64):
        order = random.permutation(n) if shuffled else np.arange(n)
        m, blocks, _ = _sizes(_started(_row(n, order, False)))
        assert (m, blocks) == (n - 1, 3 * (n - 1) - 2)
    narrow = {}
    for n in (16, 64):
        memory = _started(_row(n, random.permutation(n) if shuffled else np.arange(n), False))
        call_entry("project_closed", memory, 1, 0)
        call_entry("right_hand_side", memory, 0.0, memory.start(owners.Island.y), 0, 1)
        narrow[n] = _sizes(memory)[2]
    assert narrow == {16: 1, 64: 1}


def test_row_on_a_plate_costs_what_it_is_long() -> None:
    """Its forces are not unique, and still within a band that does not grow."""
    bands = []
    for n in (10, 20, 40):
        memory = _started(_row(n, np.random.default_rng(n).permutation(n), True))
        call_entry("right_hand_side", memory, 0.0, memory.start(owners.Island.y), 0, 1)
        m, blocks, half = _sizes(memory)
        assert memory[owners.Problem.is_null_space_banded] == 1
        # a contact with the plate meets up to two of the row, one of the row two with the plate and two of its own
        assert (m, blocks) == (2 * n - 1, n + 2 * (n - 1) + 3 * (n - 1) + 2 * (n - 2))
        bands.append(half)
    assert bands[0] == bands[1] == bands[2]


def _memory(matrix: Any, bias: Any, mu: float, sliding: Any) -> Memory:
    n = len(bias) // 3
    memory = allocate(dict.fromkeys(COUNTS, 0) | {"n_slots": n})
    memory[owners.ModelNumbers.entry_points][: len(entry_addresses())] = entry_addresses()
    memory[owners.Problem.n_active] = n
    memory[owners.Problem.acceleration_scale] = np.max(np.abs(bias))
    memory[owners.Problem.active][:n] = np.arange(n)
    write_delassus(memory, matrix)
    memory[owners.Problem.free_accelerations][: 3 * n] = bias
    memory[owners.ActiveContact.friction_coefficient][:n] = mu
    memory[owners.ActiveContact.static_coefficient][:n] = mu
    for owner in (owners.ActiveContact, owners.ContactRecord):
        memory[owner.direction][:n, 0] = 1.0
    memory[owners.ActiveContact.is_normal_force_unknown][:n] = 1
    memory[owners.ActiveContact.sticks][:n] = memory[owners.ActiveContact.is_at_rest][:n] = ~np.asarray(sliding)
    memory[owners.ActiveContact.mode_tried][:n] = Mode.STICK
    return memory


def _balls_on_plate(n: int) -> Any:
    """Return the contact rows of n unit balls on a plate, of plate and neighbour in turn, shape [6 n - 3, 6 n]."""
    rows = []
    for i in range(n):
        for axis in ((0, 0, 1), (1, 0, 0), (0, 1, 0)):
            row = np.zeros(6 * n)
            row[6 * i : 6 * i + 3], row[6 * i + 3 : 6 * i + 6] = axis, np.cross((0, 0, -1), axis)
            rows.append(row)
        for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1)) if i + 1 < n else ():
            row = np.zeros(6 * n)
            row[6 * i : 6 * i + 3], row[6 * i + 3 : 6 * i + 6] = -np.array(axis), -np.cross((1, 0, 0), axis)
            row[6 * i + 6 : 6 * i + 9], row[6 * i + 9 : 6 * i + 12] = axis, np.cross((-1, 0, 0), axis)
            rows.append(row)
    return np.array(rows)


def _weighted(jacobian: Any) -> Any:
    """Return the rows' Delassus matrix for unit masses and the inertia of solid balls."""
    return (jacobian * np.tile([1.0] * 3 + [2.5] * 3, jacobian.shape[1] // 6)) @ jacobian.T


@settings(max_examples=20, deadline=None)
@given(st.integers(6, 30), st.integers(0, 2**31), st.floats(0.0, 0.5))
def test_regular_band_is_solved(n: int, seed: int, mu: float) -> None:
    """Chains in which each contact acts on the next, some of them sliding: the held rows vanish."""
    random = np.random.default_rng(seed)
    jacobian = np.zeros((3 * n, 4 * n + 4))
    for i in range(n):
        jacobian[3 * i : 3 * i + 3, 4 * i : 4 * i + 8] = random.normal(size=(3, 8))
    matrix, bias = jacobian @ jacobian.T, random.normal(size=3 * n)
    sliding = random.random(n) < 0.3
    memory = _memory(matrix, bias, mu, sliding)
    call_entry("resolve", memory)
    assert int(memory[owners.Island.block_start][n]) == 3 * n - 2
    f = memory[owners.Problem.forces][: 3 * n]
    held = np.ones(3 * n, bool)
    held[1::3] = held[2::3] = ~sliding
    left = (matrix @ f + bias)[held]
    assert np.max(np.abs(left)) <= 1e-9 * max(1.0, np.max(np.abs(f)) * np.max(matrix))
    np.testing.assert_allclose(f[1::3][sliding], -mu * f[::3][sliding], rtol=1e-12, atol=1e-300)


@pytest.mark.parametrize("n", [8, 20])
@pytest.mark.parametrize("share", [0.0, 0.3])
def test_least_norm_in_a_band_is_that_of_the_pseudoinverse(n: int, share: float) -> None:
    """Balls in a row on a plate, forces not unique, all sticking or some sliding: 1e-10, and marked alike."""
    random = np.random.default_rng(n)
    jacobian = _balls_on_plate(n)
    matrix = _weighted(jacobian)
    m = len(matrix) // 3
    sliding = random.random(m) < share
    # consistent, as accelerations are
    bias = jacobian @ random.normal(size=6 * n)
    memories = [_memory(g, bias, 0.2, sliding) for g in (matrix, matrix + TINY)]
    for memory in memories:
        call_entry("resolve", memory)
    assert [int(memory[owners.Problem.is_null_space_banded]) for memory in memories] == [1, 0]
    assert [int(memory[owners.Problem.is_deficient]) for memory in memories] == [1, 1]
    forces = [memory[owners.Problem.forces][: 3 * m] for memory in memories]
    np.testing.assert_allclose(forces[0], forces[1], rtol=0, atol=1e-10 * np.max(np.abs(forces[1])))
    marked = [memory[owners.ActiveContact.has_redundant_force][:m].tolist() for memory in memories]
    assert marked[0] == marked[1]
    columns = np.zeros((3 * m, 0))
    for i in range(m):
        part = np.zeros((3 * m, 3))
        part[3 * i : 3 * i + 3] = np.eye(3)
        columns = np.hstack([columns, part[:, :1] - 0.2 * part[:, 1:2] if sliding[i] else part])
    held = np.ones(3 * m, bool)
    held[1::3] = held[2::3] = ~sliding
    least = columns @ (np.linalg.pinv((matrix @ columns)[held], rcond=1e-10) @ -bias[held])
    np.testing.assert_allclose(forces[0], least, rtol=0, atol=1e-10 * np.max(np.abs(least)))


@pytest.mark.parametrize("push", [0.0, 0.5, 2.0])
def test_contact_problem_in_a_band_has_the_dense_motion(push: float) -> None:
    """A row on a plate, its first ball pushed along it: the same motion, whether stored in full or in a band."""
    n = 8
    jacobian = _balls_on_plate(n)
    matrix = _weighted(jacobian)
    free = np.zeros(6 * n)
    free[2::6], free[0] = -9.81, push
    motions = []
    for g in (matrix, matrix + TINY):
        memory = _memory(g, jacobian @ free, 0.3, np.zeros(len(matrix) // 3, bool))
        assert call_entry("solve_contact", memory) == 1
        motions.append(matrix @ memory[owners.Problem.forces][: len(matrix)] + jacobian @ free)
    np.testing.assert_allclose(motions[0], motions[1], rtol=0, atol=1e-8)


def test_too_many_blocks_end_the_run() -> None:
    """Without room for the blocks of an island the run ends with that reason, and nothing is written beyond them."""
    memory = assemble(_row(6, np.arange(6), False), EventDriven()).memory
    starts = memory[owners.Island.block_start][:6]
    memory[owners.ModelNumbers.n_slots] = 2
    assert call_entry("advance", memory, 0, 0) == Status.NO_SLOT
    assert starts.tolist() == [0, 1, 2, 3, 4, 5]


def test_a_matrix_goes_in_and_out() -> None:
    """Zero blocks included, which are not stored."""
    matrix = _weighted(_balls_on_plate(4))
    memory = _memory(matrix, np.ones(len(matrix)), 0.0, np.zeros(len(matrix) // 3, bool))
    np.testing.assert_array_equal(read_delassus(memory, len(matrix) // 3), matrix)
    assert int(memory[owners.Island.block_start][:8][7]) < 49
