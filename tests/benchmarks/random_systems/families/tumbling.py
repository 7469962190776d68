"""Bodies of all kinds that tumble: on plates, on held and moving bodies, on joints, or on each other alone."""

from __future__ import annotations

from typing import Any

import numpy as np

from bodies import BallJoint, ConstantVelocity, Distance, DrivenBody, Fixed, Harmonic, Hinge, Plate, Rest, Slider
from nonsmooth.interfaces import Body, Joint, Motion
from nonsmooth.interfaces.body import Vector
from tests.benchmarks.random_systems.case import Case, Start
from tests.benchmarks.random_systems.contact_laws import laws_of
from tests.benchmarks.random_systems.solids import KINDS, Random, free_body, held_shape, number

_COUNTS = (0.34, 0.28, 0.17, 0.11, 0.06, 0.04)
"""How often a system has one to six free bodies."""


def turn(random: Random) -> tuple[float, ...]:
    """Return a quaternion: upright, about an axis of the body, or any."""
    choice = random.random()
    if choice < 0.2:
        return (1.0, 0.0, 0.0, 0.0)
    q = random.normal(size=4)
    if choice < 0.35:
        angle, axis = float(random.choice([0.5, 1.0])) * np.pi / 2, int(random.integers(3))
        q = np.array([np.cos(angle), *(np.sin(angle) * (np.arange(3) == axis))])
    return tuple((q / np.linalg.norm(q)).tolist())


def _vector(random: Random, scale: float) -> tuple[float, ...]:
    return tuple(np.round(scale * random.normal(size=3), 4).tolist())


def _plate(random: Random) -> Plate | None:
    choice = random.random()
    if choice < 0.12:
        return None
    if choice < 0.45:
        return Plate()
    if choice < 0.65:
        return Plate(Rest(slope=number(random, -0.6, 0.6)))
    frequency = number(random, 20.0, 120.0)
    amplitude = float(f"{random.uniform(0.2, 4.0) * 9.81 / (2.0 * np.pi * frequency) ** 2:.3g}")
    axis = np.array([0.0, 0.0, 1.0]) if choice < 0.85 else random.normal(size=3)
    axis /= np.linalg.norm(axis)
    return Plate(Harmonic(amplitude, frequency, number(random, 0.0, 6.28), *axis.tolist()))


def _held(random: Random, place: Vector, size: float) -> Body:
    shape = held_shape(random, str(random.choice(KINDS)), size)
    position, orientation = tuple(np.round(place, 5).tolist()), turn(random)
    motion: Motion = Rest(position=position, orientation=orientation)  # type: ignore[arg-type]
    if random.random() < 0.2:
        spin = number(random, -20.0, 20.0) if random.random() < 0.5 else 0.0
        velocity = tuple(np.round(0.2 * random.normal(size=3), 3).tolist())
        motion = ConstantVelocity(velocity, spin, position=position, orientation=orientation)  # type: ignore[arg-type]
    return DrivenBody(motion, (shape,))


def _reach(body: Body) -> float:
    return max(shape.extent for shapes in body.frames for shape in shapes)


def _places(random: Random, bodies: list[Body], floor: float | None) -> list[Vector]:
    """Return places at which no two bodies can overlap, near each other; now and then at which they may."""
    careless = random.random() < 0.03
    places: list[Vector] = []
    spread, height = 0.02, floor if floor is not None else 0.0
    for body in bodies:
        reach = _reach(body)
        while True:
            low = height + 1.01 * reach if floor is not None else -0.5 * spread
            place = np.array([*random.uniform(-spread, spread, 2), low + random.exponential(0.4 * spread)])
            apart = (
                np.linalg.norm(place - p) > 1.02 * (reach + _reach(b)) for p, b in zip(places, bodies, strict=False)
            )
            if careless or all(apart):
                break
            spread, height = 1.05 * spread, height + (0.002 if floor is not None else 0.0)
        places.append(np.round(place, 5))
    return places


def _rotation(q: tuple[float, ...]) -> Vector:
    w, v = q[0], np.array(q[1:])
    cross = np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])
    return np.asarray(np.eye(3) + 2.0 * w * cross + 2.0 * cross @ cross)


def _joint(random: Random, poses: tuple[tuple[Vector, tuple[float, ...]], tuple[Vector, tuple[float, ...]]]) -> Joint:
    """Return a joint that two bodies fulfil where they are."""
    (one, turn_one), (two, turn_two) = poses
    first_axes, second_axes = _rotation(turn_one), _rotation(turn_two)
    point = one + random.uniform(0.0, 1.0) * (two - one)
    first, second = tuple((first_axes.T @ (point - one)).tolist()), tuple((second_axes.T @ (point - two)).tolist())
    relative = np.array(
        [
            turn_one[0] * turn_two[0] + np.dot(turn_one[1:], turn_two[1:]),
            *(
                turn_one[0] * np.array(turn_two[1:])
                - turn_two[0] * np.array(turn_one[1:])
                - np.cross(turn_one[1:], turn_two[1:])
            ),
        ]
    )
    seen = tuple((relative / np.linalg.norm(relative)).tolist())
    axis = random.normal(size=3)
    axis /= np.linalg.norm(axis)
    along = tuple((first_axes.T @ axis).tolist()), tuple((second_axes.T @ axis).tolist())
    kind = int(random.choice(5, p=[0.3, 0.25, 0.2, 0.1, 0.15]))
    if kind == 0:
        return BallJoint(first, second)
    if kind == 1:
        return Hinge(first, second, *along)
    if kind == 2:
        return Distance(length=float(np.linalg.norm(two - one)))
    if kind == 3:
        return Fixed(first, second, seen)
    return Slider(first, second, along[0], seen)


def _pose(body: Body, start: Start | None) -> tuple[Vector, tuple[float, ...]] | None:
    """Return where a body starts, if that is known without the engine."""
    if start is not None:
        words = dict(start.arguments)
        return (np.array(words["position"]), words["orientation"]) if start.how == "place" else None
    motion = getattr(body, "motion", None)
    if type(motion) is Rest and motion.slope == 0.0:
        return np.array(motion.position), motion.orientation
    return None


def draw(random: Random) -> Case:
    """Draw one to six free bodies in any pose, with any laws, at rest, dropped, thrown, spinning or tied by joints."""
    size = float(random.choice([0.006, 0.012, 0.02]))
    plate = _plate(random)
    n_free = 1 + int(random.choice(len(_COUNTS), p=_COUNTS))
    n_held = int(random.random() < 0.25) + int(random.random() < 0.05)
    if plate is None and n_free + n_held == 1:
        n_free = 2
    kinds = [str(kind) for kind in random.choice(KINDS, n_free)]
    free = [free_body(random, kind, size) for kind in kinds]
    held = [_held(random, np.zeros(3), size) for _ in range(n_held)]
    steep = abs(plate.motion.slope) * 0.06 if plate is not None and isinstance(plate.motion, Rest) else 0.0
    places = _places(random, [*held, *free], None if plate is None else 0.003 + steep)
    bodies: list[Body] = [] if plate is None else [plate]
    for body, place in zip(held, places, strict=False):
        moved = body.motion  # type: ignore[attr-defined]
        words = {"position": tuple(place.tolist()), "orientation": moved.orientation}
        again = Rest(**words) if isinstance(moved, Rest) else ConstantVelocity(moved.velocity, moved.rate, **words)
        bodies.append(DrivenBody(again, body.carried))  # type: ignore[attr-defined]
    starts: list[Start | None] = [None] * len(bodies)
    first_free = len(bodies)
    weightless = plate is None and random.random() < 0.7
    thrown = weightless or random.random() < 0.45
    lies = not weightless and random.random() < 0.4
    middle = np.mean(places, axis=0)
    for body, place in zip(free, places[n_held:], strict=True):
        towards = (middle - place) * float(random.uniform(0.0, 15.0)) if thrown else np.zeros(3)
        velocity = np.round(towards + (0.3 * random.normal(size=3) if thrown else 0.0), 4)
        spin = (0.0, 0.0, 0.0) if random.random() < 0.5 else _vector(random, float(random.choice([15.0, 15.0, 150.0])))
        at: dict[str, Any] = {"position": tuple(place.tolist()), "orientation": turn(random)}
        how = ("touching", "touching", "at_height", "resting")[int(random.integers(4))] if lies else "place"
        if how == "at_height":
            at = {"height": float(f"{10.0 ** random.uniform(-5.0, -2.0):.2g}"), **at}
        if how != "resting":
            at |= {"velocity": tuple(velocity.tolist()), "angular_velocity": spin}
        starts.append(Start(how, tuple(at.items())))
        bodies.append(body)
    joints: list[tuple[int, int, Joint]] = []
    if random.random() < 0.22 and not lies:
        for k in range(first_free, len(bodies)):
            other = int(random.integers(0, k)) if k else 0
            poses = _pose(bodies[other], starts[other]), _pose(bodies[k], starts[k])
            if k == other or poses[0] is None or poses[1] is None or random.random() < 0.4:
                continue
            joints.append((other, k, _joint(random, (poses[0], poses[1]))))
    if joints:
        # what hangs together starts at rest, or flies as one
        flying = (0.0, 0.0, 0.0) if any(i < first_free for i, _, _ in joints) else starts[-1].arguments[2][1]  # type: ignore[union-attr]
        for k in range(first_free, len(bodies)):
            at = dict(starts[k].arguments) | {"velocity": flying, "angular_velocity": (0.0, 0.0, 0.0)}  # type: ignore[union-attr]
            starts[k] = Start("place", tuple(at.items()))
    tied = {(i, j) for i, j, _ in joints}
    draw = laws_of(random)
    contacts = tuple((i, j, draw()) for j in range(first_free, len(bodies)) for i in range(j) if (i, j) not in tied)
    t_end = number(random, 0.1, 0.3) if len(bodies) < 4 else number(random, 0.08, 0.16)
    return Case(tuple(bodies), tuple(starts), contacts, tuple(joints), 0.0 if weightless else 9.81, t_end)
