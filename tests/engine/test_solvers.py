"""All solvers of the contact problem give one answer, and the answer keeps the laws."""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

import nonsmooth as ns
from laws import Coulomb, Frictionless, Unilateral
from nonsmooth.engine.memory.solvers import MOST_ENUMERATED, SOLVERS, solver_of

Floats = NDArray[np.float64]
NAMED = SOLVERS[1:]
GRAVITY = 9.81


class Problem:
    """The arguments of solve_contact."""

    def __init__(self, mass: Any, jacobian: Any, force: Any, friction: Any, slip: Any = None) -> None:
        """Take the rows n, t1, t2 of every contact, shape [n, 3, n_u]."""
        self.mass, self.jacobian, self.force = np.asarray(mass), np.asarray(jacobian), np.asarray(force)
        self.friction = list(friction)
        self.slip = np.zeros((len(self.friction), 2)) if slip is None else np.asarray(slip)

    def solve(self, solver: str = "auto", order: Any = None) -> ns.ContactResult:
        """Solve it, the contacts in some other order if one is given."""
        order = np.arange(len(self.friction)) if order is None else np.asarray(order)
        columns = np.moveaxis(self.jacobian[order], 2, 0)
        laws = [self.friction[i] for i in order]
        return ns.solve_contact(
            self.mass, columns[:, :, 0], columns[:, :, 1:], self.force, laws, slip=self.slip[order], solver=solver
        )


def assert_lawful(problem: Problem, result: ns.ContactResult) -> None:
    """Hold the answer against equation of motion, complementarity and cone, all by itself."""
    forces = np.column_stack([result.normal_force, result.tangential_force])
    pushed = np.einsum("ncu,nc->u", problem.jacobian, forces)
    size = float(max(np.max(np.abs(problem.force)), np.max(np.abs(pushed))))
    np.testing.assert_allclose(problem.mass @ result.acceleration, problem.force + pushed, rtol=0, atol=1e-11 * size)
    across = problem.jacobian @ result.acceleration
    scale = size * float(np.max(np.abs(problem.jacobian))) * float(np.linalg.norm(np.linalg.inv(problem.mass), 2))
    np.testing.assert_allclose(result.contact_acceleration, across, rtol=0, atol=1e-11 * scale)
    small = 1e-8 * max(scale, float(np.max(np.abs(forces))))
    for i, law in enumerate(problem.friction):
        normal, pull, push = forces[i, 0], forces[i, 1:], across[i, 1:]
        assert Unilateral().is_fulfilled(across[i, 0], normal, small)
        if np.any(problem.slip[i] != 0.0):
            assert result.modes[i] != "stick"
            assert law.is_fulfilled(tuple(problem.slip[i]), normal, tuple(pull), small)
            continue
        assert law.is_fulfilled((0.0, 0.0), normal, tuple(pull), small)
        if result.modes[i] == "stick":
            np.testing.assert_allclose(push, 0.0, rtol=0, atol=small)
        elif result.modes[i] == "slide":
            assert np.hypot(*pull) == pytest.approx(law.parameters().get("friction", 0.0) * normal, abs=small)
            assert pull @ push == pytest.approx(-np.hypot(*pull) * np.hypot(*push), abs=small * small + small)


def _law(mu: float, excess: float = 1.0) -> Any:
    return Coulomb(mu, mu * excess) if mu > 0.0 else Frictionless()


def _spin(points: Any) -> Floats:
    """Return the rows n, t1, t2 of feet on a level plane at ``points`` of a body that turns freely."""
    rows = np.zeros((len(points), 3, 6))
    for i, r in itertools.product(range(len(points)), range(3)):
        axis = np.eye(3)[(2, 0, 1)[r]]
        rows[i, r, :3], rows[i, r, 3:] = axis, np.cross(points[i], axis)
    return rows


@st.composite
def problems(draw: Any, most: int = 8) -> Problem:
    """Draw one: bodies or feet, in the plane or in space, with or without friction and slip, repeated feet or not."""
    n = draw(st.integers(1, most))
    random = np.random.default_rng(draw(st.integers(0, 10**6)))
    mu = draw(st.sampled_from([0.0, 0.1, 0.3, 0.5]))
    one = draw(st.booleans())
    laws = [_law(mu if one else mu * random.uniform(0.2, 1.0)) for _ in range(n)]
    freedoms = draw(st.sampled_from([6, 12, 3 * n + 1]))
    if draw(st.booleans()):
        points = np.column_stack([random.uniform(-1.0, 1.0, (n, 2)), np.full(n, -0.4)])
        if draw(st.booleans()):
            points[-1] = points[0]
        jacobian = _spin(points)
        mass = np.diag(random.uniform(0.2, 1.0, 6))
        force = random.normal(size=6) * [3.0, 3.0, 1.0, 2.0, 2.0, 2.0] - [0.0, 0.0, 9.0, 0.0, 0.0, 0.0]
    else:
        jacobian = random.normal(size=(n, 3, freedoms))
        root = random.normal(size=(freedoms, freedoms))
        mass = root @ root.T / freedoms + np.eye(freedoms)
        force = random.normal(size=freedoms) - jacobian[:, 0].sum(axis=0)
    if draw(st.booleans()):
        jacobian[:, 2] = 0.0
    slip = np.zeros((n, 2))
    for i in range(n):
        if draw(st.sampled_from([False, False, True])):
            angle = random.uniform(0.0, 2.0 * math.pi)
            slip[i] = (1.0, 0.0) if np.all(jacobian[i, 2] == 0.0) else (math.cos(angle), math.sin(angle))
    return Problem(mass, jacobian, force, laws, slip)


def _attempt(problem: Problem, solver: str) -> ns.ContactResult | None:
    try:
        return problem.solve(solver)
    except ns.RunFailed:
        return None


@pytest.mark.slow
@settings(max_examples=150)
@given(problem=problems())
def test_all_solvers_agree(problem: Problem) -> None:
    """What one finds is lawful; where a criterion proves the motion unique all find it, and the same forces."""
    names = [name for name in SOLVERS if name != "enumeration" or len(problem.friction) <= 5]
    results = [result for name in names if (result := _attempt(problem, name)) is not None]
    for result in results:
        assert_lawful(problem, result)
    if not results or not results[0].proved_unique:
        return
    assert len(results) == len(names)
    size = float(np.max(np.abs(problem.force)))
    reach = float(np.max(np.abs(problem.jacobian)))
    for result in results[1:]:
        np.testing.assert_allclose(
            result.contact_acceleration, results[0].contact_acceleration, rtol=0, atol=1e-10 * size * reach**2
        )
        for name in ("normal_force", "tangential_force"):
            np.testing.assert_allclose(getattr(result, name), getattr(results[0], name), rtol=0, atol=1e-10 * size)


@settings(max_examples=60)
@given(problem=problems(most=4))
def test_the_null_space_leaves_the_motion(problem: Problem) -> None:
    """A force along it accelerates nothing, and it is empty iff the forces are told to be unique."""
    result = _attempt(problem, "auto")
    if result is None:
        return
    for change in result.null_space:
        pushed = np.einsum("ncu,nc->u", problem.jacobian, change)
        np.testing.assert_allclose(pushed, 0.0, rtol=0, atol=1e-8 * float(np.max(np.abs(problem.jacobian))))
    assert result.forces_are_unique == (len(result.null_space) == 0)


FEET = [(x, y, -0.3) for x in (-1.0, 1.0) for y in (-0.5, 0.5)]


def _block(
    feet: Any, angle: float, friction: float, static: float | None = None, yaw: float = 0.0, uphill: float = 0.0
) -> Problem:
    """Return a block of mass 1 on feet on a slope, with a moment about its normal."""
    gravity = (GRAVITY * math.sin(angle) - uphill, 0.0, -GRAVITY * math.cos(angle))
    return Problem(
        np.diag([1.0, 1.0, 1.0, 0.3, 0.4, 0.5]),
        _spin(feet),
        (*gravity, 0.0, 0.0, yaw),
        [Coulomb(friction, static)] * len(feet),
    )


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("side", [-1e-6, 1e-6])
def test_a_block_breaks_away_at_its_friction_angle(solver: str, side: float) -> None:
    """Four feet on a slope: they stick iff tan(angle) <= mu_s, and slide with mu; forces are not unique."""
    friction, static = 0.3, 0.4
    problem = _block(FEET, math.atan(static) + side, friction, static)
    result = problem.solve(solver)
    assert_lawful(problem, result)
    angle = math.atan(static) + side
    downhill = 0.0 if side < 0.0 else GRAVITY * (math.sin(angle) - friction * math.cos(angle))
    np.testing.assert_allclose(result.acceleration, (downhill, 0.0, 0.0, 0.0, 0.0, 0.0), atol=1e-12)
    assert result.modes == (("stick",) if side < 0.0 else ("slide",)) * 4
    assert not result.forces_are_unique
    # sticking: 12 forces for 6 freedoms; sliding: 4 normal forces for 3
    assert len(result.null_space) == (6 if side < 0.0 else 1)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("side", [-1e-6, 1e-6])
def test_a_moment_turns_a_block(solver: str, side: float) -> None:
    """Four feet at distance r hold a moment of mu m g r, though the sum of their friction is zero."""
    arm = math.hypot(1.0, 0.5)
    hold = 0.3 * GRAVITY * arm
    problem = _block(FEET, 0.0, 0.3, yaw=hold * (1.0 + side))
    result = problem.solve(solver)
    assert_lawful(problem, result)
    assert result.acceleration[5] == pytest.approx(0.0 if side < 0.0 else hold * side / 0.5, abs=1e-12)


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_motion_of_a_block_is_unique_as_far_as_is_searched(solver: str) -> None:
    """Below and above the friction angle, no second motion turns up."""
    for angle in (math.atan(0.3) - 1e-3, math.atan(0.3) + 1e-3):
        assert _block(FEET, angle, 0.3).solve(solver).motion_is_unique


@settings(max_examples=40)
@given(
    seed=st.integers(0, 10**6),
    angle=st.floats(0.0, 0.6),
    yaw=st.floats(-3.0, 3.0),
    repeats=st.lists(st.integers(0, 3), max_size=4),
    solver=st.sampled_from(("auto", "lemke", "gauss_seidel", "newton")),
)
def test_feet_in_the_same_place_change_nothing(
    seed: int, angle: float, yaw: float, repeats: list[int], solver: str
) -> None:
    """The motion is that of the three feet alone, however often and in what order they are given."""
    random = np.random.default_rng(seed)
    feet = [(1.0, 0.1, -0.3), (-0.8, 0.7, -0.3), (-0.6, -0.8, -0.3), (1.0, 0.1, -0.3)]
    alone = _block(feet[:3], angle, 0.3, yaw=yaw).solve(solver)
    more = _block([*feet[:3], *(feet[i] for i in repeats)], angle, 0.3, yaw=yaw)
    result = more.solve(solver, random.permutation(3 + len(repeats)))
    np.testing.assert_allclose(result.acceleration, alone.acceleration, rtol=0, atol=1e-10 * GRAVITY)


@settings(max_examples=40)
@given(problem=problems(most=5), seed=st.integers(0, 1000), solver=st.sampled_from(NAMED))
def test_the_order_of_contacts_does_not_matter(problem: Problem, seed: int, solver: str) -> None:
    """Contacts in another order: the same motion and forces, where the motion is proved unique."""
    order = np.random.default_rng(seed).permutation(len(problem.friction))
    result = _attempt(problem, solver)
    if result is None or not result.proved_unique:
        return
    other = problem.solve(solver, order)
    size = float(np.max(np.abs(problem.force)))
    np.testing.assert_allclose(other.acceleration, result.acceleration, rtol=0, atol=1e-10 * 5.0 * size)
    np.testing.assert_allclose(other.normal_force, result.normal_force[order], rtol=0, atol=1e-10 * size)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("side", [-1e-6, 1e-6])
def test_painleve_has_no_solution(solver: str, side: float) -> None:
    """Sliding with g_nn - mu g_nt at its zero, pressed in: solved below mu = 1/2, refused above."""
    delassus = np.array([[1.0, -2.0, 0.0], [-2.0, 5.0, 0.0], [0.0, 0.0, 1.0]])
    root = np.linalg.cholesky(delassus)
    problem = Problem(np.eye(3), root[None], -np.linalg.solve(root, [1.0, 0.0, 0.0]), [Coulomb(0.5 * (1.0 + side))])
    problem.slip = np.array([[-1.0, 0.0]])
    if side > 0.0:
        with pytest.raises(ns.RunFailed, match=solver):
            problem.solve(solver)
        return
    result = problem.solve(solver)
    assert result.normal_force[0] == pytest.approx(1.0 / -side, rel=1e-8)


@pytest.mark.parametrize("solver", SOLVERS)
def test_two_motions_are_told(solver: str) -> None:
    """Between the angles of mu and mu_s a block at rest may stick and may slide: it sticks, and not uniquely."""
    result = _block(FEET, 0.5 * (math.atan(0.3) + math.atan(0.5)), 0.3, 0.5).solve(solver)
    assert result.modes == ("stick",) * 4
    assert result.motion_is_unique is False
    assert not result.proved_unique


@pytest.mark.parametrize("solver", ["auto", "lemke", "gauss_seidel", "newton"])
def test_many_contacts(solver: str) -> None:
    """Forty contacts of a body with enough freedoms, one by one on the cone."""
    random = np.random.default_rng(5)
    n = 40
    jacobian = random.normal(size=(n, 3, 3 * n + 5)) / math.sqrt(3 * n)
    force = random.normal(size=3 * n + 5) - jacobian[:, 0].sum(axis=0)
    problem = Problem(np.eye(3 * n + 5), jacobian, force, [Coulomb(0.2)] * n)
    result = problem.solve(solver)
    assert_lawful(problem, result)
    assert len(set(result.modes)) == 3


def test_an_unknown_solver_is_refused_with_the_names_there_are() -> None:
    """By the function, by the engine and by the number."""
    problem = _block(FEET, 0.1, 0.3)
    for call in (
        lambda: problem.solve("lemkee"),
        lambda: ns.EventDriven(solver="lemkee"),
        lambda: solver_of("lemkee"),
    ):
        with pytest.raises(ns.UnknownName, match="'lemke'"):
            call()


def test_enumeration_refuses_too_many_contacts() -> None:
    """It would take 3^9 trials."""
    with pytest.raises(ns.InvalidInput, match=f"at most {MOST_ENUMERATED}"):
        _block([FEET[0]] * (MOST_ENUMERATED + 1), 0.1, 0.3).solve("enumeration")


def test_wrong_arrays_are_refused() -> None:
    """Shape, finiteness, a mass that is none, a normal that moves nothing."""
    good = _block(FEET, 0.1, 0.3)
    for name, value in (
        ("mass", -np.eye(6)),
        ("mass", np.eye(5)),
        ("force", np.full(6, np.nan)),
        ("jacobian", np.zeros((4, 3, 6))),
        ("slip", np.zeros((4, 3))),
    ):
        bad = _block(FEET, 0.1, 0.3)
        setattr(bad, name, value)
        with pytest.raises(ns.InvalidInput):
            bad.solve()
    assert good.solve().modes == ("stick",) * 4
