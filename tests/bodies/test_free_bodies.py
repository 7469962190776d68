"""Free bodies: Newton and Euler, free flight, inertia from dimensions, compounds."""

from __future__ import annotations

import inspect
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

import nonsmooth as ns
from bodies import (
    Ball,
    BoxBody,
    CapsuleBody,
    Compound,
    ConeBody,
    CylinderBody,
    DiscBody,
    Dumbbell,
    EllipsoidBody,
    FreeBody,
    Harmonic,
    Part,
    Plane,
    Plate,
    RigidBody,
    Rod,
    Sphere,
)
from bodies.inertia import tensor_of
from nonsmooth.engine.memory.modes import Cause
from nonsmooth.interfaces import Shape

TURNED = (math.cos(0.4), 0.6 * math.sin(0.4), 0.0, 0.8 * math.sin(0.4))
TENSOR = ((0.03, -0.004, 0.002), (-0.004, 0.025, 0.005), (0.002, 0.005, 0.04))
BODIES: list[FreeBody] = [
    Ball(0.02),
    BoxBody(0.01, 0.02, 0.035),
    CapsuleBody(0.01, 0.03, density=900.0),
    Compound((Part(BoxBody(0.01, 0.02, 0.03), (0.02, 0.0, -0.01), TURNED), Part(CylinderBody(0.01, 0.04)))),
    ConeBody(0.02, 0.05, mass=0.2),
    CylinderBody(0.02, 0.03, mass=0.2),
    DiscBody(0.05, mass=0.1),
    Dumbbell(),
    EllipsoidBody(0.01, 0.02, 0.03),
    RigidBody(2.0, TENSOR, (Sphere(0.05, x=0.1), Sphere(0.04, y=-0.1))),
    RigidBody(2.0, (0.02, 0.03, 0.04)),
    Rod(0.2, 0.005),
]
each_body = pytest.mark.parametrize("body", BODIES, ids=lambda body: type(body).__name__)
numbers = st.floats(-2.0, 2.0)
vectors = st.tuples(numbers, numbers, numbers).map(np.array)
turns = vectors.map(lambda v: np.roll(Rotation.from_rotvec(v).as_quat(), 1))


def _matrix(quaternion: Any) -> Any:
    return Rotation.from_quat(np.roll(quaternion, -1)).as_matrix()


def _tensor(body: FreeBody) -> Any:
    return tensor_of(body.inertia, body.products)


def _block(body: FreeBody, q: Any, u: Any, gravity: Any) -> dict[str, Any]:
    """Return the parts of the output block."""
    out = np.full(111, 0.0)
    pulls = dict(zip(("gravity_x", "gravity_y", "gravity_z"), np.asarray(gravity).tolist(), strict=True))
    body.evaluator(0.0, q, u, out, **{**body.parameters(), **pulls})
    sizes = {"position": 3, "axes": 9, "twist": 6, "bias": 6, "jacobian": 36, "rates": 7, "force": 6, "inverse": 36}
    parts, start = {}, 0
    for name, size in {**sizes, "energy": 2}.items():
        parts[name], start = out[start : start + size], start + size
    assert start == 111
    return parts


@pytest.mark.fast_cases(6)
@each_body
@settings(max_examples=10)
@given(place=vectors, turn=turns, velocity=vectors, spin=vectors, gravity=vectors)
def test_output_block_is_newton_and_euler(
    body: FreeBody, place: Any, turn: Any, velocity: Any, spin: Any, gravity: Any
) -> None:
    """Everything that the evaluator writes, from the tensor and matrices alone."""
    q, u = body.state(position=place, orientation=turn, velocity=velocity, angular_velocity=spin)
    parts, tensor, mass, axes = _block(body, q, u, gravity), _tensor(body), body.total_mass, _matrix(turn)

    def same(name: str, expected: Any) -> None:
        expected = np.ravel(expected)
        np.testing.assert_allclose(parts[name], expected, rtol=0, atol=1e-12 * (1.0 + np.max(np.abs(expected))))

    same("position", place)
    same("axes", axes)
    same("twist", [*velocity, *(axes @ spin)])
    # with u' = 0 the angular velocity stays in the body, and R (omega x omega) is nothing
    same("bias", np.zeros(6))
    same("jacobian", np.block([[np.eye(3), np.zeros((3, 3))], [np.zeros((3, 3)), axes]]))
    same("force", [*(mass * gravity), *(-np.cross(spin, tensor @ spin))])
    whole = np.block([[mass * np.eye(3), np.zeros((3, 3))], [np.zeros((3, 3)), tensor]])
    np.testing.assert_allclose(parts["inverse"].reshape(6, 6) @ whole, np.eye(6), rtol=0, atol=1e-12)
    same("energy", [0.5 * mass * velocity @ velocity + 0.5 * spin @ tensor @ spin, -mass * gravity @ place])
    # the quaternion after a small turn of the body, central difference
    h = 1e-6
    after, before = (Rotation.from_matrix(axes) * Rotation.from_rotvec(s * h * spin) for s in (1.0, -1.0))
    ends = [np.roll(r.as_quat(), 1) for r in (after, before)]
    one, other = (end * math.copysign(1.0, end @ q[3:]) for end in ends)
    same("rates", [*velocity, *parts["rates"][3:]])
    np.testing.assert_allclose(parts["rates"][3:], (one - other) / (2.0 * h), rtol=0, atol=1e-8)


@pytest.mark.fast_cases(10)
@each_body
@settings(max_examples=5)
@given(turn=turns, about=turns, velocity=vectors, spin=vectors, gravity=vectors)
def test_the_world_may_be_turned(body: FreeBody, turn: Any, about: Any, velocity: Any, spin: Any, gravity: Any) -> None:
    """Turned start and turned gravity give turned rates and the same energy, whatever the frame of the world."""
    world = _matrix(about)
    both = np.roll((Rotation.from_matrix(world) * Rotation.from_quat(np.roll(turn, -1))).as_quat(), 1)
    position = np.array([0.1, 0.2, 0.3])
    one = _block(
        body,
        *body.state(position=position, orientation=turn, velocity=velocity, angular_velocity=spin),
        gravity,
    )
    start = {"position": world @ position, "orientation": both, "velocity": world @ velocity, "angular_velocity": spin}
    other = _block(body, *body.state(**start), world @ gravity)
    np.testing.assert_allclose(other["twist"].reshape(2, 3), one["twist"].reshape(2, 3) @ world.T, rtol=0, atol=1e-12)
    np.testing.assert_allclose(other["energy"], one["energy"], rtol=0, atol=1e-12 * body.total_mass)
    np.testing.assert_allclose(other["inverse"], one["inverse"], rtol=1e-14)
    np.testing.assert_allclose(other["force"][:3], world @ one["force"][:3], rtol=0, atol=1e-12 * body.total_mass)
    np.testing.assert_array_equal(other["force"][3:], one["force"][3:])


@each_body
def test_free_flight_keeps_energy_and_angular_momentum(body: FreeBody) -> None:
    """Fifty turns about no principal axis, in gravity."""
    system = ns.System([body])
    spin = np.array([8.0, 25.0, 9.0])
    system.place(body, velocity=(0.3, -0.2, 4.0), orientation=TURNED, angular_velocity=spin)
    t_end = 50.0 * 2.0 * math.pi / float(np.linalg.norm(spin))
    solution = ns.simulate(system, t_end, sample_interval=0.1, engine=ns.EventDriven(tolerance=1e-11))
    tensor, axes = _tensor(body), Rotation.from_quat(np.roll(solution.q[:, 3:], -1, axis=1)).as_matrix()
    momenta = np.einsum("nij,nj->ni", axes, solution.u[:, 3:] @ tensor)
    size = float(np.linalg.norm(momenta[0]))
    np.testing.assert_allclose(momenta, np.broadcast_to(momenta[0], momenta.shape), rtol=0, atol=1e-8 * size)
    turning = 0.5 * np.einsum("ni,ij,nj->n", solution.u[:, 3:], tensor, solution.u[:, 3:])
    np.testing.assert_allclose(turning, turning[0], rtol=1e-8)
    np.testing.assert_allclose(solution.u_end[:3], [0.3, -0.2, 4.0 - 9.81 * t_end], rtol=0, atol=1e-9)


def test_the_help_of_a_start_names_the_axes_of_its_velocities() -> None:
    text = " ".join((inspect.getdoc(Ball.state) or "").split())
    assert "``velocity`` of the mass centre in world axes" in text
    assert "``angular_velocity`` in body axes" in text


def test_a_tensor_is_a_body_in_other_axes() -> None:
    """The tensor R D R^T turns in space as the principal moments D do from the orientation that R adds."""
    moments, turn = np.array([0.02, 0.03, 0.04]), _matrix(TURNED)
    given_axes = RigidBody(2.0, (turn @ np.diag(moments) @ turn.T).tolist())
    principal = RigidBody(2.0, moments.tolist())
    spin = np.array([1.0, 12.0, 2.0])
    ends = []
    for body, start, rate in ((given_axes, (1.0, 0.0, 0.0, 0.0), spin), (principal, TURNED, turn.T @ spin)):
        system = ns.System([body])
        system.place(body, orientation=start, angular_velocity=rate)
        solution = ns.simulate(system, 2.0, engine=ns.EventDriven(tolerance=1e-11))
        ends.append(_matrix(solution.q_end[3:]))
    np.testing.assert_allclose(ends[0] @ turn, ends[1], rtol=0, atol=1e-8)


# quadrature: points and weights of a unit density that are exact for the polynomials of a moment of inertia


def _gauss(low: float, high: float, n: int = 6) -> tuple[Any, Any]:
    x, w = np.polynomial.legendre.leggauss(n)
    return 0.5 * (high - low) * x + 0.5 * (high + low), 0.5 * (high - low) * w


def _revolved(pieces: Any) -> tuple[Any, Any]:
    """Return points of a solid of revolution about z; pieces are (low, high, radius squared of z)."""
    points, weights = [], []
    angles = np.arange(8) * math.pi / 4.0
    for low, high, square in pieces:
        for z, wz in zip(*_gauss(low, high), strict=True):
            for r, wr in zip(*_gauss(0.0, math.sqrt(square(z))), strict=True):
                for angle in angles:
                    points.append((r * math.cos(angle), r * math.sin(angle), z))
                    weights.append(wz * wr * r * math.pi / 4.0)
    return np.array(points), np.array(weights)


def _box(a: float, b: float, c: float) -> tuple[Any, Any]:
    grids = [_gauss(-h, h, 3) for h in (a, b, c)]
    points = np.stack(np.meshgrid(*[x for x, _ in grids], indexing="ij"), axis=-1).reshape(-1, 3)
    weights = np.einsum("i,j,k->ijk", *[w for _, w in grids]).ravel()
    return points, weights


def _ellipsoid(a: float, b: float, c: float) -> tuple[Any, Any]:
    points, weights = _revolved([(-1.0, 1.0, lambda z: 1.0 - z * z)])
    return points * np.array([a, b, c]), weights * a * b * c


def _capsule(r: float, h: float) -> tuple[Any, Any]:
    ends = [(h, h + r, lambda z: r * r - (z - h) ** 2), (-h - r, -h, lambda z: r * r - (z + h) ** 2)]
    return _revolved([(-h, h, lambda _: r * r), *ends])


def _about_centre(points: Any, weights: Any) -> Any:
    x = points - weights @ points / np.sum(weights)
    return np.einsum("n,nk,nk->", weights, x, x) * np.eye(3) - np.einsum("n,ni,nj->ij", weights, x, x)


SOLIDS: list[tuple[Any, tuple[Any, Any]]] = [
    (BoxBody(0.01, 0.02, 0.035, density=500.0), _box(0.01, 0.02, 0.035)),
    (CylinderBody(0.02, 0.03, density=500.0), _revolved([(-0.03, 0.03, lambda _: 4e-4)])),
    (ConeBody(0.02, 0.06, density=500.0), _revolved([(-0.015, 0.045, lambda z: ((0.045 - z) / 3.0) ** 2)])),
    (CapsuleBody(0.01, 0.03, density=500.0), _capsule(0.01, 0.03)),
    (EllipsoidBody(0.01, 0.02, 0.03, density=500.0), _ellipsoid(0.01, 0.02, 0.03)),
    (Ball(0.02, 500.0), _ellipsoid(0.02, 0.02, 0.02)),
]


@pytest.mark.parametrize(("body", "rule"), SOLIDS, ids=lambda x: type(x).__name__)
def test_mass_and_inertia_of_solids(body: FreeBody, rule: Any) -> None:
    """Closed forms against the integral of the density; the shapes are as large as the solids."""
    points, weights = rule
    assert body.total_mass == pytest.approx(500.0 * np.sum(weights), rel=1e-12)
    np.testing.assert_allclose(_tensor(body), 500.0 * _about_centre(points, weights), rtol=1e-12, atol=1e-16)
    (shape,) = body.shapes
    assert shape.length >= float(np.max(np.linalg.norm(points, axis=1)))


def test_a_ball_has_the_mass_that_is_given_or_that_of_its_density() -> None:
    assert Ball(0.02, mass=0.3).total_mass == 0.3
    assert Ball(0.02, mass=0.3).inertia[0] == pytest.approx(0.4 * 0.3 * 0.02**2)
    assert Ball(0.02).total_mass == Ball(0.02, density=7800.0).total_mass == Ball(0.02, 7800.0).total_mass


def test_thin_bodies_are_limits_of_solid_ones() -> None:
    """A disc is a flat cylinder, a rod a slender capsule."""
    disc, flat = DiscBody(0.1, mass=0.3), CylinderBody(0.1, 1e-5, mass=0.3)
    np.testing.assert_allclose(disc.inertia, flat.inertia, rtol=1e-7)
    rod, slender = Rod(1.0, 1e-4, mass=0.3), CapsuleBody(1e-4, 0.5, mass=0.3)
    np.testing.assert_allclose(rod.inertia, np.roll(slender.inertia, 1), rtol=1e-3)
    assert rod.shapes[0].length == pytest.approx(slender.shapes[0].length)
    assert DiscBody(0.1, surface_density=2.0).total_mass == pytest.approx(2.0 * math.pi * 0.01)
    assert Rod(1.0, 1e-3, density=1000.0).total_mass == pytest.approx(1000.0 * math.pi * 1e-6)


def test_mesh_of_a_box() -> None:
    """An independent program finds the same mass and inertia."""
    import trimesh

    mesh = trimesh.creation.box(extents=(0.02, 0.04, 0.07))
    mesh.density = 500.0
    body = BoxBody(0.01, 0.02, 0.035, density=500.0)
    assert body.total_mass == pytest.approx(mesh.mass)
    np.testing.assert_allclose(_tensor(body), mesh.moment_inertia, rtol=1e-12, atol=1e-16)


@pytest.mark.slow
@given(place=vectors, turn=turns, other=vectors)
def test_compound_is_the_integral_over_its_parts(place: Any, turn: Any, other: Any) -> None:
    """Mass, mass centre, tensor; and the shapes stand where the parts do."""
    parts = (
        Part(BoxBody(0.1, 0.2, 0.35, density=500.0), tuple(place), tuple(turn)),
        Part(CylinderBody(0.2, 0.3, density=800.0), tuple(other)),
    )
    body = Compound(parts)
    (one, w_one), (two, w_two) = _box(0.1, 0.2, 0.35), _revolved([(-0.3, 0.3, lambda _: 0.04)])
    points = np.concatenate([one @ _matrix(turn).T + place, two + other])
    weights = np.concatenate([500.0 * w_one, 800.0 * w_two])
    centre = weights @ points / np.sum(weights)
    assert body.total_mass == pytest.approx(np.sum(weights))
    np.testing.assert_allclose(body.centre, centre, rtol=0, atol=1e-12)
    tensor = _about_centre(points, weights)
    np.testing.assert_allclose(_tensor(body), tensor, rtol=0, atol=1e-12 * np.max(tensor))
    box, cylinder = (shape.parameters() for shape in body.shapes)
    np.testing.assert_allclose([box[c] for c in "xyz"], place - centre, rtol=0, atol=1e-12)
    np.testing.assert_allclose([cylinder[c] for c in "xyz"], other - centre, rtol=0, atol=1e-12)
    np.testing.assert_allclose(_matrix([box[f"orientation_{c}"] for c in "wxyz"]), _matrix(turn), rtol=0, atol=1e-12)


def test_a_compound_is_a_dumbbell() -> None:
    """Two balls and no rod, from their parts; a turned cylinder takes its axis along."""
    reference = Dumbbell(0.01, 3.9, rod_mass_fraction=0.0)
    half = reference.centre_distance / 2.0
    body = Compound((Part(Ball(0.01), (1.0 - half, 2.0, 3.0)), Part(Ball(0.01), (1.0 + half, 2.0, 3.0))))
    assert body.centre == pytest.approx((1.0, 2.0, 3.0))
    assert body.total_mass == pytest.approx(reference.total_mass)
    assert body.inertia == pytest.approx(reference.inertia)
    for shape, other in zip(body.shapes, reference.shapes, strict=True):
        assert shape.parameters() == pytest.approx(other.parameters(), abs=1e-15)
    quarter = (math.sqrt(0.5), math.sqrt(0.5), 0.0, 0.0)
    (lying,) = Compound((Part(CylinderBody(0.01, 0.03), orientation=quarter),)).shapes
    assert [lying.parameters()[f"axis_{c}"] for c in "xyz"] == pytest.approx([0.0, -1.0, 0.0])


@dataclass(frozen=True)
class _Weightless(FreeBody):
    """A body of a user's own that forgets its mass."""

    @property
    def total_mass(self) -> float:
        return 0.0

    @property
    def inertia(self) -> tuple[float, float, float]:
        return 1.0, 1.0, 1.0

    @property
    def shapes(self) -> tuple[Shape, ...]:
        return ()


BAD: list[tuple[Any, dict[str, Any], tuple[str, ...]]] = [
    (_Weightless, {}, ("mass of _Weightless", "positive", "0.0")),
    (RigidBody, {"mass": 0.0, "tensor": TENSOR}, ("RigidBody.mass", "> 0", "0.0")),
    (RigidBody, {"mass": -1.0, "tensor": TENSOR}, ("RigidBody.mass", "> 0", "-1.0")),
    (RigidBody, {"mass": 1.0, "tensor": (1.0, 1.0)}, ("RigidBody.tensor", "three principal moments or", "3 x 3")),
    (RigidBody, {"mass": 1.0, "tensor": (1.0, math.nan, 1.0)}, ("RigidBody.tensor", "3 finite numbers", "nan")),
    (RigidBody, {"mass": 1.0, "tensor": [[1, 0.1, 0], [0, 1, 0], [0, 0, 1]]}, ("RigidBody.tensor", "symmetric")),
    (RigidBody, {"mass": 1.0, "tensor": [[1, 2, 0], [2, 1, 0], [0, 0, 1]]}, ("inertia", "positive definite", "-1.0")),
    (RigidBody, {"mass": 1.0, "tensor": (1.0, 1.0, 0.0)}, ("inertia of RigidBody", "positive definite")),
    (RigidBody, {"mass": 1.0, "tensor": (1.0, 1.0, 2.1)}, ("inertia of RigidBody", "larger than the sum", "2.1")),
    (RigidBody, {"mass": 1.0, "tensor": TENSOR, "carried": Sphere(1.0)}, ("RigidBody.carried", "tuple of shapes")),
    (RigidBody, {"mass": 1.0, "tensor": TENSOR, "carried": (3,)}, ("RigidBody.carried", "shapes only", "3")),
    (BoxBody, {"half_x": 0.0, "half_y": 1.0, "half_z": 1.0}, ("BoxBody.half_x", "> 0")),
    (BoxBody, {"half_x": 1, "half_y": 1, "half_z": 1, "mass": 0.0}, ("BoxBody.mass", "> 0")),
    (
        CylinderBody,
        {"radius": 1.0, "half_length": 1.0, "mass": 1.0, "density": 20.0},
        ("CylinderBody.mass", "together"),
    ),
    (Ball, {"radius": 1.0, "mass": 1.0, "density": 20.0}, ("Ball.mass", "together")),
    (Ball, {"radius": 0.02, "mass": -1.0}, ("Ball.mass", "> 0")),
    (ConeBody, {"radius": 1.0, "height": 1.0, "mass": 1.0, "density": 20.0}, ("ConeBody.mass", "together")),
    (ConeBody, {"radius": 1.0, "height": 0.1, "foot_height": 0.06}, ("ConeBody.foot_height", "half the length")),
    (CapsuleBody, {"radius": 1.0, "half_length": -1.0}, ("CapsuleBody.half_length", "> 0")),
    (EllipsoidBody, {"semi_x": 1.0, "semi_y": 1.0, "semi_z": math.inf}, ("EllipsoidBody.semi_z", "finite")),
    (DiscBody, {"radius": 1.0, "mass": 1.0, "surface_density": 1.0}, ("DiscBody.mass", "together")),
    (Rod, {"centre_distance": 1.0, "radius": 0.0}, ("Rod.radius", "> 0")),
    (Compound, {"parts": ()}, ("Compound.parts", "at least one part")),
    (Compound, {"parts": (Ball(0.1),)}, ("Compound.parts", "parts only")),
    (Part, {"body": Plate()}, ("Part.body", "free body")),
    (Part, {"body": Ball(0.1), "position": (1.0, 2.0)}, ("Part.position", "3 finite numbers", "[m]")),
    (Part, {"body": Ball(0.1), "orientation": (1.0, 1.0, 0.0, 0.0)}, ("Part.orientation", "unit quaternion")),
    (Compound, {"parts": (Part(RigidBody(1.0, TENSOR, (Plane(),))),)}, ("shape of a part", "x, y, z", "Plane")),
]


@pytest.mark.parametrize(("kind", "arguments", "words"), BAD)
def test_bad_bodies(kind: Any, arguments: dict[str, Any], words: tuple[str, ...]) -> None:
    """The message names the thing, the rule and the value."""
    with pytest.raises(ns.InvalidInput) as caught:
        kind(**arguments)
    for word in words:
        assert word in str(caught.value)


def test_inertia_at_the_bound() -> None:
    """A disc has one moment that is the sum of the others; a needle's smallest may be tiny."""
    RigidBody(1.0, (1.0, 1.0, 2.0))
    RigidBody(1.0, (1.0, 1.0, 1e-9))
    assert RigidBody(1.0, (1.0, 1.0, 1.0)).scales[0][0] == 1.0


@pytest.mark.parametrize("body", [body for body in BODIES if body.shapes], ids=lambda body: type(body).__name__)
def test_every_body_falls_on_a_plate(build: Any, body: FreeBody) -> None:
    """Tumbling onto a vibrating plate, it strikes, and the energy account closes."""
    system = build.over(body, Harmonic(amplitude=5e-4, frequency=20.0), friction=0.3, restitution=0.6)
    ns.at_height(system, body, 0.01, orientation=TURNED, velocity=(0.2, 0.1, 0.0), angular_velocity=(3.0, 5.0, 1.0))
    solution = ns.simulate(system, 0.25)
    assert np.count_nonzero(solution.events.cause == Cause.IMPACT) >= 2
    assert solution.energy.residual <= 1e-8
