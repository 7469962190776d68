"""Short runs and single problems of every kind, whose numbers are compared between compiled and plain.

``NONSMOOTH_PLAIN=1 python -m tests.engine.plain_cases FILE`` writes them to a file, with the names of the engine's
functions that they entered.
"""

from __future__ import annotations

import cProfile
import math
import pickle
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

import nonsmooth as ns
from bodies import (
    Ball,
    BallJoint,
    BoxBody,
    ConstantVelocity,
    DrivenBody,
    Dumbbell,
    FunctionLoad,
    Harmonic,
    PlanarBody,
    Plate,
    Point,
    Rest,
    Spring,
    SuperellipsoidBody,
    TriangleMesh,
    Triangles,
)
from bodies.contacts.surface.surface_pairs import MOST_NEAR
from bodies.meshes.patches import patches_for_ball
from bodies.shapes.box import Box
from laws import (
    Anisotropic,
    Bristle,
    Coulomb,
    EnergeticImpact,
    Frictionless,
    HuntCrossley,
    MonoStiffnessImpact,
    NewtonImpact,
    RateAndState,
    Unilateral,
)
from nonsmooth import engine
from nonsmooth.engine.memory.solvers import SOLVERS
from nonsmooth.engines.event_driven import PainlevePolicy
from tests.bodies.meshes.parts import hills
from tests.engine.test_inelastic import impact, wedged
from tests.laws.test_stiff_slips import rod
from tests.physics.test_own_guards import Level
from tests.physics.test_wedged_impacts import resting_wedge

Numbers: TypeAlias = dict[str, Any]


def _numbers(system: ns.System, t_end: float, **options: Any) -> Numbers:
    """Return what a run gives; one that ends early, too."""
    try:
        s = ns.simulate(system, t_end, sample_interval=t_end / 20.0, engine=ns.EventDriven(**options))
    except ns.RunFailed as failure:
        if not isinstance(failure.solution, ns.Solution):
            raise
        s = failure.solution
    forces = s.history("mode", "normal_force", "friction_force", "joint_force", times=s.t[1::7])
    return {
        "state": s.at(0.37 * s.t_end)["q"],
        "contact": forces["mode"] > 0,
        "normal force": forces["normal_force"],
        "friction": forces["friction_force"],
        "joint force": forces["joint_force"],
        "status": [s.status],
        "cause": s.events.cause,
        "after": s.events.after,
        "time": s.events.time,
        "q": s.q,
        "u": s.u,
        "impulse": s.events.impulse,
        "wrong": [s.energy.residual],
        "cost": [s.counters.steps + s.counters.rejected + s.counters.impact_steps + s.counters.gap_looks],
    }


_IMPACT, _FRICTION = EnergeticImpact(0.65), Coulomb(0.2, 0.25)


def _rigid(impact: Any = _IMPACT, friction: Any = _FRICTION) -> Numbers:
    return {"normal": Unilateral(), "friction": friction, "impact": impact}


def _soft(friction: Any) -> Numbers:
    return {"normal": HuntCrossley(1e8, 0.5), "friction": friction}


def _dumbbell(laws: Numbers, periods: float, skew: float = 0.1) -> Numbers:
    plate = Plate(Harmonic(amplitude=0.9 * 9.81 / (50 * math.pi) ** 2, frequency=25.0))
    body = Dumbbell()
    system = ns.System([plate, body])
    system.contact(plate, body, **laws)
    half, tilt = body.centre_distance / 2, math.radians(10)
    system.place(
        body,
        position=(half * math.cos(tilt), 0, body.radius + half * math.sin(tilt)),
        orientation=(math.cos(tilt / 2), 0, -math.sin(tilt / 2), 0),
        velocity=(0, skew, 0),
    )
    return _numbers(system, periods / 25.0)


def jamming(share: float) -> ns.System:
    """Let a dumbbell slide ahead of its mass centre with a share of the friction for which no force exists."""
    plate, body = Plate(), Dumbbell(rod_mass_fraction=0.9)
    half, tilt = body.centre_distance / 2, math.radians(45.0)
    x, z = half * math.cos(tilt), half * math.sin(tilt) + body.radius
    critical = (body.inertia[1] / body.total_mass + x * x) / (x * z)
    system = ns.System([plate, body])
    system.contact(plate, body, **_rigid(EnergeticImpact(0.3), Coulomb(share * critical)))
    system.place(
        body, position=(x, 0, z), orientation=(math.cos(tilt / 2), 0, -math.sin(tilt / 2), 0), velocity=(-1.0, 0.0, 0.0)
    )
    return system


def _jam(policy: str, share: float) -> Numbers:
    return _numbers(jamming(share), 5e-4, painleve=policy)


def _box(tilt: float, spin: float, t_end: float, slope: float = 0.0) -> Numbers:
    plate, box = Plate(), BoxBody(0.01, 0.012, 0.02)
    system = ns.System([plate, box])
    system.contact(plate, box, **_rigid(EnergeticImpact(0.3), Coulomb(0.4)))
    low = 0.02 * math.cos(tilt) + 0.01 * math.sin(abs(tilt))
    system.place(
        box,
        position=(0.0, 0.0, low),
        orientation=(math.cos(tilt / 2), 0.0, math.sin(tilt / 2), 0.0),
        velocity=(slope, 0.0, 0.0),
        angular_velocity=(0.0, 0.0, spin),
    )
    return _numbers(system, t_end)


def _tower(n: int) -> Numbers:
    """Put boxes on each other, whose contacts are redundant."""
    plate, boxes = Plate(), [BoxBody(0.01, 0.01, 0.01) for _ in range(n)]
    system = ns.System([plate, *boxes])
    for i, box in enumerate(boxes):
        system.contact(boxes[i - 1] if i else plate, box, **_rigid(EnergeticImpact(0.3), Coulomb(0.3)))
        system.place(box, position=(0.0, 0.0, 0.01 + 0.02 * i))
    return _numbers(system, 1e-4)


def _shaken() -> Numbers:
    """Shake a plate with a block on it: stick, slip, stick."""
    plate, block = Plate(Harmonic(1e-3, 10.0, 0.0, 1.0, 0.0, 0.0)), PlanarBody(2.0, 1.0, (Point(),))
    system = ns.System([plate, block])
    system.contact(plate, block, **_rigid(friction=Coulomb(0.1, 0.2)))
    system.place(block, velocity=(2e-3 * math.pi * 10.0, 0.0))
    return _numbers(system, 0.12)


def _pendulum() -> Numbers:
    """Hang two balls on joints, drawn by a spring; the lower one strikes the plate and passes a level."""
    plate, upper, lower = Plate(), Ball(0.01), Ball(0.01)
    system = ns.System([plate, upper, lower])
    system.contact(plate, lower, **_rigid())
    system.joint(BallJoint((0.0, 0.0, 0.08), (0.0, 0.0, 0.05)), plate, upper)
    system.joint(BallJoint((0.0, 0.0, 0.0), (0.0, 0.0, 0.03)), upper, lower)
    system.load(Spring(stiffness=5.0, length=0.05), plate, lower)
    system.guard(Level(0.04))
    x, z = -0.05 * math.sin(0.8), 0.08 - 0.05 * math.cos(0.8)
    system.place(upper, position=(x, 0.0, z), orientation=(math.cos(0.4), 0.0, math.sin(0.4), 0.0))
    system.place(lower, position=(x, 0.0, z - 0.03))
    return _numbers(system, 0.05)


def _balls(n: int, plate: bool, laws: Numbers, t_end: float, **options: Any) -> Numbers:
    """Strike a row that touches at one end, on a plate or in empty space."""
    ground, balls = Plate(), [Ball(0.01) for _ in range(n)]
    system = ns.System([*([ground] if plate else []), *balls], gravity=9.81 if plate else 0.0)
    for i, ball in enumerate(balls):
        if plate:
            system.contact(ball, ground, **laws)
        if i:
            system.contact(balls[i - 1], ball, **laws)
        end = i == n - 1
        system.place(ball, position=(0.02 * i + 1e-4 * end, 0.0, 0.01), velocity=(-1.0 * end, 0.0, 0.0))
    return _numbers(system, t_end, **options)


def _rolling() -> Numbers:
    """Let a ball roll towards one at rest while a third one bounces."""
    ground, balls = Plate(), [Ball(0.01) for _ in range(3)]
    system = ns.System([ground, *balls])
    for ball in balls:
        system.contact(ground, ball, **_rigid())
    system.contact(balls[0], balls[1], **_rigid())
    system.place(balls[0], position=(0.0, 0.0, 0.01), velocity=(0.2, 0.0, 0.0), angular_velocity=(0.0, 20.0, 0.0))
    system.place(balls[1], position=(0.021, 0.0, 0.01))
    system.place(balls[2], position=(0.1, 0.0, 0.0105))
    return _numbers(system, 0.04)


def _cloud(n: int) -> Numbers:
    """Let balls on a lattice fly at each other, all pairs of them in contact."""
    rng, balls = np.random.default_rng(3), [Ball(0.01) for _ in range(n)]
    system = ns.System(balls, gravity=0.0)
    side = math.ceil(n ** (1.0 / 3.0))
    for i, (ball, cell) in enumerate(zip(balls, np.ndindex(side, side, side), strict=False)):
        for other in balls[:i]:
            system.contact(other, ball, **_rigid(EnergeticImpact(0.9), Frictionless()))
        place = 0.05 * (np.array(cell) - 0.5 * (side - 1))
        system.place(ball, position=place, velocity=-4.0 * place + 0.3 * rng.normal(size=3))
    return _numbers(system, 0.05)


def _hills() -> Numbers:
    """Let a box fall on hills, whose features are searched for."""
    ground, body = DrivenBody(carried=(TriangleMesh(Triangles(*hills(4))),)), BoxBody(0.1, 0.07, 0.05, mass=1.0)
    system = ns.System([ground, body])
    assert len(system.contact(ground, body, **_rigid())) == MOST_NEAR
    turn = np.array([0.7, 0.3, -0.2, 0.4])
    system.place(body, position=(0.1, 0.1, 0.13), orientation=turn / np.linalg.norm(turn), velocity=(0.1, 0.0, -1.0))
    return _numbers(system, 0.03)


def _border(rate: float, way: float) -> Numbers:
    """Let a ball roll from an edge onto a face [rad/s], from so far before it [m]: fast ones close both at once."""
    mesh, radius = TriangleMesh(Triangles(*hills(6))), 0.03
    features = mesh.features
    patches = patches_for_ball(features, radius)
    for edge, (_, _, left, right) in enumerate(features.edges):
        upwards = min(features.planes[left, 2], features.planes[right, 2]) > 0.5
        if upwards and patches.of_edges[edge] != patches.of_faces[left]:
            break
    start, end = features.vertices[list(features.edges[edge][:2])]
    normal = features.planes[left, :3]
    along = (end - start) / np.linalg.norm(end - start)
    arm = radius * normal - way * np.cross(normal, along)
    ground, ball = DrivenBody(carried=(mesh,)), Ball(radius)
    system = ns.System([ground, ball])
    system.contact(ground, ball, **_rigid())
    spin = -rate * along
    system.place(
        ball,
        position=0.5 * (start + end) + radius * arm / np.linalg.norm(arm),
        velocity=np.cross(spin, arm),
        angular_velocity=spin,
    )
    return _numbers(system, 1e-4)


def _flat() -> Numbers:
    """Let a boxy body roll over the middle of its face, where its contact point has no bound in speed."""
    plate, body = Plate(), SuperellipsoidBody(0.01, 0.012, 0.009, exponent_along=0.6, exponent_across=0.6)
    system = ns.System([plate, body])
    system.contact(plate, body, **_rigid(NewtonImpact(0.0)))
    system.place(body, position=(0.0, 0.0, 0.009), angular_velocity=(8.0, 0.0, 0.0))
    return _numbers(system, 2e-3)


def _resting_wedge() -> Numbers:
    """Let a contact close beside others that rest, whose slips leave their bounds slowly."""
    result = ns.solve_impact(*resting_wedge(2367))
    return {"velocity": result.velocity, "impulse": result.normal_impulse, "lost": result.friction_loss}


def _groove() -> Numbers:
    """Let a ball sink into a groove, slower than bounces are, and slip along it."""
    half = math.pi / 8.0
    sides = [Plate(Rest(orientation=(math.cos(half), 0.0, sign * math.sin(half), 0.0))) for sign in (1.0, -1.0)]
    ball = Ball(0.01)
    system = ns.System([*sides, ball])
    for side in sides:
        system.contact(side, ball, **_rigid(EnergeticImpact(0.5, duration=1e-3), Coulomb(0.3)))
    system.place(ball, position=(0.0, 0.0, math.sqrt(2.0) * 0.01), velocity=(0.0, 0.05, -5e-3))
    return _numbers(system, 5e-3)


def _bouncing() -> Numbers:
    """Let a ball bounce and spin until it rests."""
    plate, ball = Plate(), Ball(0.01)
    system = ns.System([plate, ball])
    system.contact(plate, ball, **_rigid(EnergeticImpact(0.5, duration=1e-3), Coulomb(0.3)))
    system.place(ball, position=(0.0, 0.0, 0.03), velocity=(0.1, 0.0, 0.0), angular_velocity=(0.0, 0.0, 3.0))
    return _numbers(system, 0.5)


def _over_an_edge() -> Numbers:
    """Let a ball slide over the edge of a box and off."""
    table, ball = DrivenBody(carried=(Box(0.1, 0.1, 0.1),)), Ball(0.02)
    system = ns.System([table, ball])
    system.contact(table, ball, **_rigid(EnergeticImpact(0.0), Frictionless()))
    system.place(ball, position=(0.096, 0.0, 0.12), velocity=(0.2, 0.0, 0.0))
    return _numbers(system, 0.14)


def _squeezed() -> Numbers:
    """Lower a lid onto a ball, slower than bounces are: no impulse stops it on both sides."""
    lid = Plate(
        ConstantVelocity(position=(0.0, 0.0, 0.02), velocity=(0.0, 0.0, -1e-7), orientation=(0.0, 1.0, 0.0, 0.0))
    )
    sides, ball = (Plate(), lid), Ball(0.01)
    system = ns.System([*sides, ball])
    for side in sides:
        system.contact(side, ball, **_rigid(EnergeticImpact(0.5, duration=1e-3), Coulomb(0.3)))
    system.place(ball, position=(0.0, 0.0, 0.01))
    return _numbers(system, 1e-5)


def _contact_problem(seed: int, n: int, n_u: int, solver: str, sliding: bool) -> Numbers:
    """Solve for random contacts, more of them than the velocities need where n_u is small."""
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(n_u, n_u))
    normal, tangential = rng.normal(size=(n_u, n)), rng.normal(size=(n_u, n, 2))
    slip = rng.normal(size=(n, 2)) * (rng.uniform(size=(n, 1)) < 0.4) if sliding else np.zeros((n, 2))
    force = -normal.sum(axis=1) + 0.3 * rng.normal(size=n_u)
    try:
        result = ns.solve_contact(
            root @ root.T + n_u * np.eye(n_u),
            normal,
            tangential,
            force,
            [Coulomb(0.3, 0.4)] * n,
            slip=slip,
            solver=solver,
        )
    except ns.NonsmoothError as error:
        return {"refused": [str(error)]}
    return {"modes": result.modes, "acceleration": result.acceleration, "normal": result.normal_force}


def _doubled_chain(n: int, solver: str) -> Numbers:
    """Press points against each other and a wall by two contacts each: redundant, and each acts on few others."""
    columns = np.zeros((3 * n, 2 * n, 3))
    for i in range(n):
        for c in (2 * i, 2 * i + 1):
            columns[3 * i : 3 * i + 3, c] = np.eye(3)
            if i:
                columns[3 * i - 3 : 3 * i, c] = -np.eye(3)
    laws = [Coulomb(0.3), Coulomb(0.02)] * n
    force = np.tile([-1.0, 0.08, 0.06], n)
    result = ns.solve_contact(np.eye(3 * n), columns[:, :, 0], columns[:, :, 1:], force, laws, solver=solver)
    return {"modes": result.modes, "acceleration": result.acceleration, "normal": result.normal_force}


def _creeping(t_end: float = 0.02) -> Numbers:
    """Drag a ball by a force that turns and falls below the bound of friction, until its slip stops."""
    ground, ball = Plate(), Ball(0.01, density=1000.0)
    system = ns.System([ground, ball])
    system.contact(ground, ball, **_rigid(friction=Coulomb(0.3)))
    system.place(ball, position=(0.0, 0.0, 0.01), velocity=(5e-4, 0.0, 0.0))
    system.load(FunctionLoad(_dragging, {"bound": 3.5 * 0.3 * 9.81 * ball.total_mass}), ground, ball)
    return _numbers(system, t_end, tolerance=1e-8)


def _dragging(t: float, a: Any, b: Any, out: Any, bound: float) -> None:
    for i in range(9):
        out[i] = b[i - 3] if 3 <= i < 6 else 0.0
    size = bound * (0.999 - 0.5 * t)
    out[0], out[1] = size * math.cos(7.0 * t), size * math.sin(7.0 * t)


def _next_to_the_bound(seed: int) -> Numbers:
    """Let a point of a light rod strike with slip and with 1e-5 less friction than holds it."""
    mass, columns, bound = rod(seed)
    u = np.linalg.lstsq(columns.T, [-1.0, 0.6, 0.8], rcond=None)[0]
    result = ns.solve_impact(
        mass, columns[:, :1], columns[:, 1:].reshape(6, 1, 2), u, [_IMPACT], [Coulomb((1.0 - 1e-5) * bound)]
    )
    return _impact_numbers(mass, u, result)


def _impact_problem(seed: int, n: int, law: Any) -> Numbers:
    rng = np.random.default_rng(seed)
    n_u = 3 * n + 1
    normal, tangential, u = rng.normal(size=(n_u, n)), rng.normal(size=(n_u, n, 2)), rng.normal(size=n_u)
    u = -u if np.all(normal.T @ u >= 0.0) else u
    mass = np.diag(rng.uniform(0.5, 2.0, n_u))
    result = ns.solve_impact(mass, normal, tangential, u, [law] * n, [Coulomb(0.2, 0.3)] * n)
    return _impact_numbers(mass, u, result)


def _impact_numbers(mass: Any, u: Any, result: ns.ImpactResult) -> Numbers:
    lost = 0.5 * (u @ mass @ u - result.velocity @ mass @ result.velocity)
    booked = np.sum(result.restitution_loss + result.friction_loss)
    return {
        "velocity": result.velocity,
        "normal": result.normal_impulse,
        "stored": result.stored,
        "wrong": [(booked - lost) / (u @ mass @ u)],
        "cost": [result.steps],
    }


CASES: dict[str, Callable[[], Numbers]] = {
    "drift": lambda: _dumbbell(_rigid(), 4, 0.0),
    "skew": lambda: _dumbbell(_rigid(), 1, 1.0),
    "newton": lambda: _dumbbell(_rigid(NewtonImpact(0.65)), 1),
    "mono-stiffness": lambda: _dumbbell(_rigid(MonoStiffnessImpact(0.65)), 1),
    "compliant": lambda: _dumbbell(_soft(Coulomb(0.2, 0.25)), 1),
    "bristle": lambda: _dumbbell(_soft(Bristle(0.2, 0.25)), 1),
    "anisotropic": lambda: _dumbbell(_rigid(friction=Anisotropic(0.2, 0.3)), 1),
    "rate and state": lambda: _dumbbell(_rigid(friction=RateAndState(0.2, 0.01, 0.02, 1e-3, 1e-4)), 1),
    **{f"no force, {policy}": lambda policy=policy: _jam(policy, 1.001) for policy in PainlevePolicy},  # type: ignore[misc]
    "into the singularity": lambda: _jam("impact", 0.999),
    "axis along the normal": lambda: _dumbbell(_rigid(friction=Anisotropic(0.2, 0.3, (0.0, 0.0, 1.0), "first")), 0.5),
    "tower": lambda: _tower(2),
    "rocking box": lambda: _box(0.1, 0.0, 0.12),
    "sliding box": lambda: _box(0.0, 0.0, 0.05, 0.2),
    "stopping box": lambda: _box(0.0, 0.3, 5e-3, 3e-3),
    "spinning box": lambda: _box(0.3, 3.0, 0.08),
    "pendulum": _pendulum,
    "shaken": _shaken,
    "row": lambda: _balls(5, False, _rigid(EnergeticImpact(0.9), Frictionless()), 1e-3),
    "row on a plate": lambda: _balls(4, True, _rigid(EnergeticImpact(0.5), Coulomb(0.3)), 1e-3),
    "long row": lambda: _balls(18, False, _rigid(EnergeticImpact(0.9), Frictionless()), 2e-4, impact_tolerance=1e-5),
    "rolling": _rolling,
    "cloud": lambda: _cloud(13),
    "hills": _hills,
    "border": lambda: _border(60.0, 1e-9),
    "flat": _flat,
    "groove": _groove,
    "squeezed": _squeezed,
    "bouncing": _bouncing,
    "creeping": _creeping,
    **{f"next to the bound, {n}": lambda n=n: _next_to_the_bound(n) for n in (1, 4)},  # type: ignore[misc]
    "over an edge": _over_an_edge,
    "resting wedge": _resting_wedge,
    "wedged impacts": lambda: {str(seed): impact(*wedged(seed))[1] for seed in range(60)},
    "slow border": lambda: _border(12.0, 3e-9),
    **{
        f"contact problem, {solver}, {n} contacts, {n_u} velocities, sliding {sliding}": (
            lambda solver=solver, n=n, n_u=n_u, sliding=sliding: _contact_problem(n, n, n_u, solver, sliding)  # type: ignore[misc]
        )
        for solver in SOLVERS
        for n, n_u, sliding in ((2, 6, True), (3, 9, False), (4, 6, False))
    },
    **{f"doubled chain of {n}": lambda n=n: _doubled_chain(n, "auto") for n in (2, 6)},  # type: ignore[misc]
    **{f"impact problem {n}": lambda n=n: _impact_problem(n, n, EnergeticImpact(0.6)) for n in (1, 2, 3)},  # type: ignore[misc]
}
"""By name; every one gives arrays by name."""


def entered(run: Callable[[], Any]) -> tuple[Any, set[str]]:
    """Return what a function returns and the functions of the engine that it entered, as "folder/module.function"."""
    # in C: a function called by sys.setprofile takes longer than the cases themselves
    profile = cProfile.Profile(subcalls=False, builtins=False)
    result = profile.runcall(run)
    codes = {entry.code for entry in profile.getstats() if not isinstance(entry.code, str)}
    paths = {(Path(code.co_filename), code.co_name) for code in codes}
    folder = Path(engine.__path__[0])
    return result, {
        f"{path.relative_to(folder).with_suffix('').as_posix()}.{name}"
        for path, name in paths
        if path.is_relative_to(folder)
    }


if __name__ == "__main__":
    found = entered(lambda: {name: case() for name, case in CASES.items()})
    Path(sys.argv[1]).write_bytes(pickle.dumps(found))
