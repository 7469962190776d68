"""What all impact laws have in common, and which of them may gain energy."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import nonsmooth as ns
from bodies import Ball, Plate
from laws import Coulomb, MoreauImpact, NewtonImpact, PoissonImpact, StrongeImpact, Unilateral
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import ImpactLaw
from tests.laws.impact_problems import LAWS, E, Problem, apply, draw, solve

SEEDS = st.integers(0, 10**6)
SIZES = st.integers(1, 3)
every_law = pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
few = settings(max_examples=15)


@every_law
@few
@given(seed=SEEDS, n=SIZES)
def test_impulses_push_within_the_cone_and_nothing_approaches(law: ImpactLaw, seed: int, n: int) -> None:
    """P_N >= 0, |P_T| <= mu P_N, g'+ >= 0, M (u+ - u-) = W P."""
    problem = draw(seed, n)
    after, impulse = solve([law] * n, problem)
    size = float(np.max(np.abs(impulse)))
    assert size > 0.0
    assert np.all(impulse[:, 0] >= 0.0)
    assert np.all(np.hypot(*impulse[:, 1:].T) <= problem.friction * impulse[:, 0] + 1e-9 * size)
    assert np.all(problem.normal.T @ after >= -1e-7)
    np.testing.assert_allclose(problem.mass @ (after - problem.velocity), problem.columns @ impulse.ravel(), atol=1e-9)


@every_law
@few
@given(seed=SEEDS, n=SIZES)
def test_energy_is_lost_where_all_approach_alike(law: ImpactLaw, seed: int, n: int) -> None:
    """All contacts approach, with the same coefficients; Newton's law without friction only."""
    problem = draw(seed, n, 0.0 if isinstance(law, NewtonImpact) else 0.4, approach=True)
    after, _ = solve([law] * n, problem)
    assert problem.energy(after) <= problem.energy(problem.velocity) * (1.0 + 1e-9)


@every_law
@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_what_cannot_move_along_the_tangents_rebounds(law: ImpactLaw, friction: float) -> None:
    """A body on a rail, of one coordinate."""
    problem = Problem(np.eye(1) * 2.0, np.ones((1, 1)), np.zeros((1, 1, 2)), -np.ones(1), np.array([friction]))
    after, impulse = solve([law], problem)
    assert 0.0 <= after[0] < 1.0
    if "restitution" in law.parameters():
        assert after[0] == pytest.approx(E)
    assert impulse[0, 0] == pytest.approx(2.0 * (after[0] + 1.0))
    assert np.hypot(*impulse[0, 1:]) <= friction * impulse[0, 0] + 1e-12


@every_law
@few
@given(seed=SEEDS, scale=st.floats(0.01, 100.0))
def test_scale_of_speed_and_mass(law: ImpactLaw, seed: int, scale: float) -> None:
    """Velocities s times as large give s times the impulses, if the law's own speed grows with them; so do masses."""
    problem = draw(seed)
    after, impulse = solve([law] * 2, problem)
    speeds = {n: scale * getattr(law, n) for n in law.parameters() if n.endswith("_speed")}
    faster = dataclasses.replace(problem, velocity=scale * problem.velocity)
    other, others = solve([dataclasses.replace(law, **speeds)] * 2, faster)  # type: ignore[type-var]
    np.testing.assert_allclose(other, scale * after, rtol=0, atol=1e-7 * scale)
    np.testing.assert_allclose(others, scale * impulse, rtol=0, atol=1e-7 * scale)
    other, others = solve([law] * 2, dataclasses.replace(problem, mass=scale * problem.mass))
    np.testing.assert_allclose(other, after, rtol=0, atol=1e-7)
    np.testing.assert_allclose(others, scale * impulse, rtol=0, atol=1e-7 * scale)


@every_law
@few
@given(seed=SEEDS, angle=st.floats(-3.0, 3.0), other=st.floats(-3.0, 3.0))
def test_tangents_may_be_turned(law: ImpactLaw, seed: int, angle: float, other: float) -> None:
    """Which axes span the tangent plane of a contact does not matter, nor does the order of the contacts."""
    problem = draw(seed)
    after, impulse = solve([law] * 2, problem)
    turns = np.array([[[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]] for a in (angle, other)])
    turned = dataclasses.replace(problem, tangential=np.einsum("unj,njk->unk", problem.tangential, turns))
    velocity, impulses = solve([law] * 2, turned)
    np.testing.assert_allclose(velocity, after, rtol=0, atol=1e-7)
    np.testing.assert_allclose(np.einsum("nk,njk->nj", impulses[:, 1:], turns), impulse[:, 1:], rtol=0, atol=1e-7)
    swapped = Problem(
        problem.mass,
        problem.normal[:, ::-1],
        problem.tangential[:, ::-1],
        problem.velocity,
        problem.friction[::-1],
    )
    velocity, impulses = solve([law] * 2, swapped)
    np.testing.assert_allclose(velocity, after, rtol=0, atol=1e-7)
    np.testing.assert_allclose(impulses[::-1], impulse, rtol=0, atol=1e-7)


@pytest.mark.parametrize("name", ["energetic", "mono-stiffness", "newton", "poisson", "moreau"])
def test_one_coefficient_on_one_contact(name: str) -> None:
    """Without friction all laws with a coefficient are g'+ = -e g'-."""
    problem = draw(3, 1, 0.0)
    after, _ = solve([LAWS[name]], problem)
    assert problem.normal[:, 0] @ after == pytest.approx(-E * problem.rates[0, 0], rel=1e-9)


@pytest.mark.parametrize("name", ["newton", "poisson", "moreau"])
@pytest.mark.parametrize("n", [1, 3])
def test_without_restitution_all_maps_are_the_plastic_one(name: str, n: int) -> None:
    """E = 0 leaves one contact problem."""
    zero = {key: 0.0 for key in LAWS[name].parameters() if key.endswith("restitution")}
    problem = draw(5, n)
    _, plastic = solve([LAWS["plastic"]] * n, problem)
    _, impulse = solve([dataclasses.replace(LAWS[name], **zero)] * n, problem)  # type: ignore[type-var]
    np.testing.assert_allclose(impulse, plastic, rtol=0, atol=1e-10)


@few
@given(seed=SEEDS, n=SIZES)
def test_plastic_loss_is_that_of_carnot(seed: int, n: int) -> None:
    """Without friction the loss is the energy of the change of velocity."""
    problem = draw(seed, n, 0.0)
    after, _ = solve([LAWS["plastic"]] * n, problem)
    lost = problem.energy(problem.velocity) - problem.energy(after)
    assert lost == pytest.approx(problem.energy(after - problem.velocity), rel=1e-9)


@few
@given(seed=SEEDS, n=SIZES, e=st.lists(st.floats(0.0, 1.0), min_size=3, max_size=3))
def test_poisson_without_friction_loses_with_any_coefficients(seed: int, n: int, e: list[float]) -> None:
    """Also where they differ and where some contacts separate."""
    problem = draw(seed, n, 0.0)
    after, _ = solve([PoissonImpact(x) for x in e[:n]], problem)
    assert problem.energy(after) <= problem.energy(problem.velocity) * (1.0 + 1e-9)


def _gain(laws: list[ImpactLaw], delassus: Any, rates: Any, friction: Any) -> float:
    """Return the work of the impulses relative to the energy that the contacts can reach."""
    impulse = apply(laws, delassus, rates, friction).ravel()
    before = np.ravel(rates)
    return float(impulse @ (before + 0.5 * delassus @ impulse) / (0.5 * before @ np.linalg.solve(delassus, before)))


def test_where_maps_gain_energy() -> None:
    """The documentation of the maps says so: Kane's kind of example, different coefficients, a separating contact."""
    # a slender rod of unit mass and length on its end, 20 degrees off the vertical, sliding
    sine, cosine = 0.5 * np.sin(np.radians(20.0)), 0.5 * np.cos(np.radians(20.0))
    columns = np.array([[0.0, 1.0, sine], [1.0, 0.0, -cosine]])
    rod = np.diag([0.0, 0.0, 1.0])
    rod[:2, :2] = columns @ np.diag([1.0, 1.0, 12.0]) @ columns.T
    gains: dict[str, list[float]] = {}
    for slip in np.linspace(-2.0, 2.0, 41):
        for name, law in (
            ("newton", NewtonImpact(1.0)),
            ("moreau 0", MoreauImpact(1.0, 0.0)),
            ("moreau 1", MoreauImpact(1.0, 1.0)),
            ("poisson", PoissonImpact(1.0)),
            ("plastic", LAWS["plastic"]),
            ("stronge", StrongeImpact(1.0)),
        ):
            gains.setdefault(name, []).append(_gain([law], rod, [[-1.0, slip, 0.0]], [0.7]))
    assert max(gains["newton"]) > 0.05
    assert gains["moreau 0"] == gains["newton"]
    for name in ("moreau 1", "poisson", "plastic", "stronge"):
        assert max(gains[name]) <= 1e-12
    # two contacts without friction, G = [[1.632, -1.443], [-1.443, 1.28]], the first one separating
    pair = np.eye(6)
    pair[np.ix_([0, 3], [0, 3])] = [[1.632, -1.443], [-1.443, 1.28]]
    rates = np.array([[0.376, 0.0, 0.0], [-0.581, 0.0, 0.0]])
    assert _gain([NewtonImpact(0.8)] * 2, pair, rates, [0.0, 0.0]) > 1.0
    # both approach, with different coefficients
    rates = np.array([[-0.319, 0.0, 0.0], [0.304, 0.0, 0.0]])
    assert _gain([PoissonImpact(0.8), PoissonImpact(0.1)], pair, rates, [0.0, 0.0]) <= 0.0


def test_poisson_gains_with_friction_and_different_coefficients() -> None:
    """What its documentation warns of, and with one coefficient not."""
    half = np.array(
        [
            [4.255579055, 0.313298502, -3.480276538, 2.517812434, -4.088682801, -2.953131831],
            [0.0, 11.030102614, 4.291035165, -6.745585903, -0.137099938, -1.299482234],
            [0.0, 0.0, 9.348549749, -6.062833323, 4.197405561, -0.9536707],
            [0.0, 0.0, 0.0, 7.500590839, -4.222139517, -1.638088098],
            [0.0, 0.0, 0.0, 0.0, 9.881404198, 3.235898736],
            [0.0, 0.0, 0.0, 0.0, 0.0, 6.55389172],
        ]
    )
    delassus = half + half.T - np.diag(np.diag(half))
    assert np.linalg.eigvalsh(delassus)[0] > 0.0
    rates = np.array([[-2.32860695, -1.06278061, -0.11263589], [-0.90382232, 1.23233458, 2.29815546]])
    friction = [1.11872269, 0.78029362]
    assert _gain([PoissonImpact(0.071), PoissonImpact(0.933)], delassus, rates, friction) > 1.0
    for e in (0.071, 0.933, 1.0):
        assert _gain([PoissonImpact(e)] * 2, delassus, rates, friction) <= 0.0


def test_what_cannot_be_solved_is_no_number() -> None:
    """A map writes no impulses that do not fulfil its law."""
    delassus = np.array([[1.0, 3.0, 0.0], [3.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    assert np.isnan(apply([NewtonImpact(0.5)], delassus, [[-1.0, 0.0, 0.0]], [0.9])[0, 0])


@pytest.mark.parametrize("law", [*LAWS.values(), StrongeImpact(E)], ids=[*LAWS, "stronge"])
@pytest.mark.parametrize("speed", [0.1, 3.0], ids=["sticks", "slides"])
def test_oblique_impact_of_a_sphere(law: ImpactLaw, speed: float) -> None:
    """In a run: sticks if |v_t| <= 3.5 mu (1 + e) |v_n|, else loses as much; with e_T it comes back."""
    mu, fall = 0.2, 1.0
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball], gravity=0.0)
    system.contact(plate, ball, normal=Unilateral(), friction=Coulomb(mu), impact=law)
    system.place(ball, position=(0.0, 0.0, 0.02), velocity=(0.6 * speed, 0.8 * speed, -fall))
    solution = ns.simulate(system, 0.02)
    (hit,) = np.flatnonzero(solution.events.cause == Cause.IMPACT)
    after = solution.events.u_after[hit]
    e = after[2] / fall
    if law not in (LAWS["plastic"], LAWS["johnson"], LAWS["viscoelastic"]):
        assert e == pytest.approx(E, rel=1e-9)
    elastic = law.parameters().get("tangential_restitution", 0.0)
    assert isinstance(elastic, float)
    bound = 3.5 * mu * (1.0 + e) * fall
    slip = -elastic * speed if (1.0 + elastic) * speed <= bound else speed - bound
    contact = np.array([after[0] - 0.01 * after[4], after[1] + 0.01 * after[3]])
    np.testing.assert_allclose(contact, [0.6 * slip, 0.8 * slip], rtol=0, atol=1e-8)
    assert solution.energy.residual <= 1e-9


@every_law
def test_momentum_of_three_balls(law: ImpactLaw) -> None:
    """In a run: momentum and moment of momentum of balls that collide stay, and all energy is accounted for."""
    balls = [Ball(0.01), Ball(0.012), Ball(0.01)]
    system = ns.System(balls, gravity=0.0)
    for one, other in ((0, 1), (1, 2), (0, 2)):
        system.contact(balls[one], balls[other], normal=Unilateral(), friction=Coulomb(0.3), impact=law)
    system.place(balls[0], position=(-0.03, 0.004, 0.001), velocity=(1.0, 0.0, 0.1), angular_velocity=(5.0, 0.0, 9.0))
    system.place(balls[1], position=(0.0, 0.0, 0.0))
    # balls 2 and 3 touch, so that the first impact is of both contacts
    system.place(balls[2], position=(0.022 * 0.8, 0.022 * 0.6, 0.0))
    solution = ns.simulate(system, 0.05)
    radii = np.array([ball.radius for ball in balls])
    masses = np.array([ball.total_mass for ball in balls])
    inertias = 0.4 * masses * radii**2
    totals = []
    for q, u in ((solution.q[0], solution.u[0]), (solution.q_end, solution.u_end)):
        places, speeds, spins = q.reshape(3, 7)[:, :3], u.reshape(3, 6)[:, :3], u.reshape(3, 6)[:, 3:]
        axes = [_rotation(x) for x in q.reshape(3, 7)[:, 3:]]
        own = sum(inertia * axis @ spin for inertia, axis, spin in zip(inertias, axes, spins, strict=True))
        totals.append(np.concatenate([masses @ speeds, own + np.cross(places, masses[:, None] * speeds).sum(axis=0)]))
    assert solution.events.count(Cause.IMPACT) >= 1
    assert np.all(solution.events.impulse[solution.events.cause == Cause.IMPACT][0][:2, 0] > 0.0)
    np.testing.assert_allclose(totals[1], totals[0], rtol=0, atol=1e-12)
    assert solution.energy.residual <= 1e-8


def _rotation(quaternion: Any) -> Any:
    from scipy.spatial.transform import Rotation

    return Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()
