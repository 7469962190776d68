"""Boxy superellipsoids: curvature, flat places, bodies that meet face to corner and edge to edge, and their motion."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import BoxBody, Cylinder, EllipsoidBody, Superellipsoid, SuperellipsoidBody, TriangleMesh, Triangles
from bodies.contacts.smooth.boxy_newton import place_on as _place_on
from bodies.contacts.smooth.smooth_core import Cores as _Cores
from bodies.contacts.smooth.smooth_newton import largest_gap
from bodies.shapes.support_function import boxy_gauge_of as _boxy_gauge_of
from bodies.shapes.support_function import support_of as _support_of
from laws import Coulomb, EnergeticImpact, Frictionless, Unilateral
from nonsmooth.engine.native.kernel import PLAIN
from tests.bodies.carriers import Rig, Stand
from tests.bodies.meshes import parts

# called with arrays in place of tuples
Cores: Any = _Cores
place_on: Any = _place_on
boxy_gauge_of: Any = _boxy_gauge_of
support_of: Any = _support_of

Array = NDArray[np.float64]
GAPS = (1e-1, 1e-3, 1e-5, 1e-7, 1e-9, -1e-9, -1e-7, -1e-5, -1e-4)
"""[m]"""


def _core(rng: np.random.Generator, low: float, high: float) -> Any:
    sizes, exponents = rng.uniform(0.004, 0.01, 3).tolist(), rng.uniform(low, high, 2).tolist()
    return np.array(Superellipsoid(*sizes, *exponents).core)


@settings(max_examples=50, deadline=None)
@given(st.floats(0.2, 0.99), st.floats(0.2, 1.0), st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3))
def test_gauge_and_support_function_belong_together(along: float, across: float, way: list[float]) -> None:
    """The support point along the normal is the point; the shape operator is the change of the normal."""
    if np.min(np.abs(way)) < 0.05:
        return
    core = np.array(Superellipsoid(0.2, 0.3, 0.4, along, across).core)
    place: Any = place_on(core, way)
    point, normal, tangents = np.array(place[0]), place[1], np.array(place[2:4])
    f = boxy_gauge_of(core, point)
    assert f[0] == pytest.approx(1.0, rel=1e-13)
    np.testing.assert_allclose(support_of(core, normal)[1], point, rtol=0, atol=1e-12)
    step = 1e-5 * np.min(np.abs(point))
    curve = np.array([place[4][:2], place[4][1:]])
    for i, t in enumerate(tangents):
        high, low = (np.array(place_on(core, point + sign * step * t)[1]) for sign in (1.0, -1.0))
        found = tangents @ (high - low) / (2.0 * step)
        np.testing.assert_allclose(found, curve[i], rtol=0, atol=1e-7 * (1.0 + np.max(np.abs(curve))) / min(along, 0.5))


@pytest.mark.parametrize("along", [0.2, 0.5, 0.9])
def test_the_farthest_point(along: float) -> None:
    """Against a search round the section with the longest axis, and the corner of a body that is nearly a cube."""
    body = Superellipsoid(0.2, 0.2, 0.3, along, 1.0)

    def reach(angle: float) -> float:
        direction = np.array([np.cos(angle), 0.0, np.sin(angle)])
        return -1.0 / float(boxy_gauge_of(np.array(body.core), direction)[0])

    best = minimize_scalar(reach, bounds=(0.0, 0.5 * np.pi), method="bounded", options={"xatol": 1e-12})
    assert body.length == pytest.approx(-best.fun, rel=1e-9)
    cube = Superellipsoid(0.1, 0.1, 0.1, along, along)
    # |x|^(2/e) three times is 1
    assert cube.boxy
    assert not Superellipsoid(0.1, 0.1, 0.1, 1.2, 1.2).boxy
    assert cube.length == pytest.approx(np.sqrt(3.0) * 0.1 * 3.0 ** (-0.5 * along), rel=1e-12)


def test_towards_the_box_and_the_ellipsoid() -> None:
    """Volume and inertia between both, monotonous in the exponents, those of the ellipsoid in the limit."""
    bodies = [SuperellipsoidBody(0.02, 0.03, 0.04, e, e, mass=1.0) for e in (0.2, 0.4, 0.6, 0.8, 0.9999)]
    box, ball = BoxBody(0.02, 0.03, 0.04, mass=1.0), EllipsoidBody(0.02, 0.03, 0.04, mass=1.0)
    rows = np.array([box.inertia, *(body.inertia for body in bodies), ball.inertia])
    assert np.all(np.diff(rows, axis=0) < 0.0)
    np.testing.assert_allclose(rows[-2], rows[-1], rtol=1e-3)


def _touching(rng: np.random.Generator, low: float, on_faces: bool, other: Any, gap: float) -> tuple[Any, ...]:
    """Return two cores, rotation and centre of the second, and the normal: of a random direction or a random point."""
    one, two = _core(rng, low, min(low + 0.2, 0.99)), other(rng)
    turn, n = Rotation.random(random_state=rng).as_matrix(), rng.normal(size=3)
    s = place_on(one, n)
    n = np.array(s[1]) if on_faces else n / np.linalg.norm(n)
    p = np.array(s[0]) if on_faces else np.array(support_of(one, n)[1])
    q = np.array(support_of(two, (-turn.T @ n))[1])
    return one, two, turn, p + gap * n - turn @ q, n


OTHERS = {
    "itself": lambda rng: _core(rng, 0.2, 0.9),
    "ellipsoid": lambda rng: np.array(Superellipsoid(*rng.uniform(0.004, 0.01, 3).tolist()).core),
    "round": lambda rng: _core(rng, 1.1, 1.5),
}


@pytest.mark.fast_cases(4)
@pytest.mark.parametrize("on_faces", [False, True], ids=["any normal", "any point"])
@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("low", [0.2, 0.6])
def test_gaps_of_known_poses(low: float, other: str, on_faces: bool) -> None:
    """Faces, edges and corners; the point comes out where the normal hardly changes, too; from either side."""
    rng = np.random.default_rng(7)
    for gap in GAPS:
        for _ in range(1 if PLAIN else 8):
            one, two, turn, x, n = _touching(rng, low, on_faces, OTHERS[other], gap)
            for swapped in (False, True):
                there = -turn.T @ x if swapped else x
                pair = (two, one, turn.T) if swapped else (one, two, turn)
                g, _, normal = largest_gap(Cores(*pair[:2], tuple(pair[2].ravel()), tuple(there)))
                assert abs(g - gap) <= 1e-12
                np.testing.assert_allclose(-turn @ np.array(normal) if swapped else normal, n, rtol=0, atol=1e-9)


def test_a_body_on_its_face_is_found_at_its_middle() -> None:
    """Where the radius of curvature is infinite; the other is an ellipsoid, then a corner."""
    core = np.array(Superellipsoid(0.01, 0.01, 0.01, 0.2, 0.2).core)
    ball = np.array(Superellipsoid(0.004, 0.005, 0.006).core)
    same = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    found = largest_gap(Cores(core, ball, same, (0.0, 0.0, 0.017)))
    np.testing.assert_allclose(
        [found[0], *found[1], *found[2]], [0.001, 0.0, 0.0, 0.011, 0.0, 0.0, 1.0], rtol=0, atol=1e-16
    )


@pytest.mark.slow
def test_it_finds_a_surface_that_is_not_convex(build: Any) -> None:
    """In the inner corner of a bracket it has a contact with either wall, in the middle of a face."""
    mesh, boxy = TriangleMesh(Triangles(*parts.bracket(), "bracket")), Superellipsoid(3e-3, 2e-3, 4e-3, 0.3, 0.5)
    rig = Rig((mesh, boxy), build.laws())
    upright = np.array([1.0, 0.0, 0.0, 0.0])
    rig.put([(np.zeros(3), upright), (np.array([0.013, 0.012, 0.007]), upright)], np.zeros(12))
    touching = rig.geometry[(np.abs(rig.geometry[:, 0]) < 1e-15) & (rig.geometry[:, 30] <= 0.0)]
    np.testing.assert_allclose(sorted(touching[:, 1:4].tolist()), [[0, 1, 0], [1, 0, 0]], atol=1e-15)
    points = sorted(touching[:, 7:10].tolist())
    np.testing.assert_allclose(points, [[0.01, 0.012, 0.007], [0.013, 0.01, 0.007]], atol=1e-15)


def _on_cylinder(cylinder: Cylinder, body: Any, friction: Any, t_end: float, **start: Any) -> ns.Solution:
    stand = Stand((cylinder,))
    system = ns.System([stand, body], gravity=9.81)
    system.contact(stand, body, normal=Unilateral(), friction=friction, impact=EnergeticImpact(0.3))
    system.place(body, **start)
    return ns.simulate(system, t_end)


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
@pytest.mark.parametrize("exponent", [0.5, 0.8])
def test_it_slides_down_the_side_of_a_cylinder(exponent: float) -> None:
    """On the middle of a face along the highest line, without friction, as a point does on a slope."""
    lean, t_end, body = 0.4, 0.15, SuperellipsoidBody(0.01, 0.012, 0.008, exponent, exponent)
    up, down = np.array([np.sin(lean), 0.0, np.cos(lean)]), np.array([np.cos(lean), 0.0, -np.sin(lean)])
    pole, begin = Cylinder(0.02, 0.2, axis_x=float(down[0]), axis_z=float(down[2])), 0.028 * up - 0.05 * down
    turn = np.array([np.cos(0.5 * lean), 0.0, np.sin(0.5 * lean), 0.0])
    solution = _on_cylinder(pole, body, Frictionless(), t_end, position=begin, orientation=turn)
    assert solution.status == "done"
    end = begin + 0.5 * 9.81 * np.sin(lean) * t_end**2 * down
    np.testing.assert_allclose(solution.q_end[:3], end, rtol=0, atol=1e-12)


@pytest.mark.slow
@pytest.mark.skipif(PLAIN, reason="a minute in plain mode")
def test_it_rolls_and_slides_off_a_log() -> None:
    """It falls on the side of a lying cylinder, stays in contact, rolls and slides off; the books balance."""
    log, rng = Cylinder(0.02, 0.05, axis_x=1.0, axis_z=0.0), np.random.default_rng(0)
    for friction in (Frictionless(), Coulomb(0.3)):
        body, turn = SuperellipsoidBody(0.01, 0.012, 0.008, 0.8, 0.8), rng.normal(size=4)
        spin = tuple((3.0 * rng.normal(size=3)).tolist())
        start = {"position": (0.0, 0.002, 0.035), "orientation": turn / np.linalg.norm(turn), "angular_velocity": spin}
        solution = _on_cylinder(log, body, friction, 0.3, **start)
        assert solution.status == "done"
        assert solution.counters.impacts > 3
        assert solution.energy.residual <= 1e-8
        # it is off the log
        assert solution.q_end[2] < 0.0
