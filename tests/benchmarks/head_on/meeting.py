"""Meeting: a body flies at another one, and the run is compared with the closed form."""

from __future__ import annotations

import math
import time
import warnings
import zlib
from dataclasses import dataclass
from typing import Any

import numpy as np

import nonsmooth as ns
from laws import Coulomb, EnergeticImpact, Unilateral
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.body import Vector
from tests.benchmarks.head_on.measured import TOUCHES, gap, shadow_gap
from tests.benchmarks.head_on.pairs import PAIRS, Pair
from tests.benchmarks.random_systems.convex import CORNERS
from tests.benchmarks.random_systems.families.aligned import UPRIGHT, Turn, about, product
from tests.benchmarks.random_systems.gaps import farthest
from tests.benchmarks.random_systems.pieces import Piece, pieces_of, rotations
from tests.benchmarks.random_systems.through import passed

E = 0.5
"""Coefficient of restitution."""
DISTANCE = 0.02
"""Usual distance of the bodies at the start along the line of their motion [m]."""
SHIFTS = ((0.0, 0.0), (1e-12, 0.0), (1e-9, 1e-9), (1e-6, 0.0), (1e-6, 1e-6), (1e-3, 0.0), (5e-3, 3e-3))
"""Shifts of the second body across the line [m]."""
TURNS = (0.0, 1e-9, 1e-6, 1e-3, 1e-2, 0.3, 0.5 * math.pi)
"""Angles of the second body about the line [rad]."""
SPEEDS = (0.1, 1.0, 10.0)
"""Speeds of the first body [m/s]."""
SPEED, TIME, DEPTH, MOMENTUM = 1e-7, 1e-12, 1e-9, 1e-10
"""Error of a speed relative to that of the first body, of a time [s], deepest overlap [m], error of the momentum."""
EDGES = 1e-8
"""Clearance up to which discs without thickness may collide edge to edge [m]: 1e-7 of their size of 0.1 m."""
LEAST = 1e-9
"""Velocity after a collision, relative to the speed before: the normal of rims that cross may be next to across."""
MARKS = {".": "right", "X": "passed", "F": "failed", "~": "wrong speed"}


@dataclass(frozen=True)
class Meeting:
    """How two bodies meet.

    Attributes
    ----------
    name : str
        Name of the pair.
    axis : int
        Axis of the bodies along which the first one flies.
    shift : tuple of float
        Shift of the second one across the line [m].
    turn : float
        Angle of the second one about the line [rad].
    speed : float
        Speed of the first one [m/s].
    world : tuple of float
        Orientation of the first one, and of the line.
    distance : float
        Distance of the bodies at the start along the line [m].
    """

    name: str
    axis: int
    shift: tuple[float, float] = (0.0, 0.0)
    turn: float = 0.0
    speed: float = 1.0
    world: Turn = UPRIGHT
    distance: float = DISTANCE


@dataclass(frozen=True)
class Verdict:
    """Mark, reason, speed of the second body relative to that of the first, processor time [s]."""

    mark: str
    reason: str = ""
    speed: float = math.nan
    seconds: float = 0.0


def drawn(name: str, number: int, seed: int) -> Meeting:
    """Return the meeting of a number of a pair; the same at every call."""
    random = np.random.default_rng([seed, number, zlib.crc32(name.encode())])
    world = UPRIGHT
    if random.random() < 0.5:
        q = random.normal(size=4)
        world = tuple((q / np.linalg.norm(q)).tolist())
    shift, turn = SHIFTS[random.integers(len(SHIFTS))], TURNS[random.integers(len(TURNS))]
    return Meeting(name, int(random.integers(3)), shift, turn, SPEEDS[random.integers(len(SPEEDS))], world)


def _reach(pieces: list[Piece], way: Vector) -> float:
    return max(farthest(piece, way) for piece in pieces)


def _feet(pieces: list[Piece]) -> float:
    return max(piece.slack for piece in pieces)


@dataclass(frozen=True)
class Placed:
    """The bodies where they start, with their pieces and the direction of the motion."""

    meeting: Meeting
    pair: Pair
    bodies: tuple[Body, Body]
    pieces: tuple[list[Piece], list[Piece]]
    way: Vector
    place: Vector
    turns: tuple[Turn, Turn]

    @classmethod
    def of(cls, meeting: Meeting) -> Placed:
        """Place the bodies of a meeting."""
        pair, along = PAIRS[meeting.name], np.eye(3)[meeting.axis]
        seen = pieces_of(pair.seen[0]()), pieces_of(pair.seen[1]())
        turn = about(along, meeting.turn)
        # turned about the line, a body reaches as far along it
        apart = _reach(seen[0], along) + _reach(seen[1], -along) + meeting.distance
        place = apart * along + np.roll([0.0, *meeting.shift], meeting.axis)
        axes = rotations(np.array([meeting.world]))[0]
        turns = meeting.world, product(meeting.world, turn)
        return cls(meeting, pair, (pair.one(), pair.two()), seen, axes @ along, axes @ place, turns)

    def system(self, **laws: Any) -> ns.System:
        """Return the system: the first body flies at the second one, which is at rest."""
        given = {"normal": Unilateral(), "friction": Coulomb(0.0), "impact": EnergeticImpact(E), **laws}
        system = ns.System(list(self.bodies), gravity=0.0)
        system.contact(*self.bodies, **given)
        system.place(self.bodies[0], orientation=self.turns[0], velocity=tuple(self.meeting.speed * self.way))
        system.place(self.bodies[1], orientation=self.turns[1], position=tuple(self.place))
        return system

    @property
    def is_central(self) -> bool:
        """Whether the impact is central."""
        return max(self.meeting.shift) == 0.0 and self.meeting.axis in self.pair.central

    @property
    def clearance(self) -> float:
        """Gap of the shadows of the bodies along the line [m]."""
        poses = [rotations(np.array([turn]))[0] for turn in self.turns]
        return shadow_gap(*self.pieces, (np.zeros(3), poses[0]), (self.place, poses[1]), self.way)

    @property
    def collides(self) -> bool:
        """Whether the first body alone would come into the second one; of bodies of parts, by poses on its way."""
        if self.clearance > -DEPTH:
            return False
        axes = [rotations(np.array([turn]))[0] for turn in self.turns]
        ways = (flown * self.way for flown in np.linspace(0.0, 2.0 * DISTANCE, 17)[1:])
        is_convex = all(len(pieces) == 1 for pieces in self.pieces)
        return is_convex or any(gap(*self.pieces, (way, axes[0]), (self.place, axes[1])) < -DEPTH for way in ways)

    @property
    def instants(self) -> tuple[float, float] | None:
        """Bounds of the time of the collision by the closed form [s]; None if there is no closed form."""
        flat = all(piece.kind == CORNERS for pieces in self.pieces for piece in pieces)
        alike = self.meeting.name.startswith("cylinder") and self.meeting.name != "cylinder, cone"
        if max(self.meeting.shift) > 0.0 or not (flat or alike):
            return None
        # cylinders end to end stand on their feet, at most one foot on another
        feet = sum(map(_feet, self.pieces)) if self.meeting.axis == 2 else 0.0
        return (self.meeting.distance - feet) / self.meeting.speed, self.meeting.distance / self.meeting.speed

    def depth(self, q: Vector) -> tuple[float, int]:
        """Return the deepest overlap over some poses [m], and the number of the pose; the feet may be inside."""
        allowed, n = sum(map(_feet, self.pieces)), self.bodies[0].n_q
        one, two = (rotations(part[:, 3:7]) for part in (q[:, :n], q[:, n:]))
        deepest, at = -math.inf, 0
        for k, row in enumerate(q):
            depth = -gap(*self.pieces, (row[:3], one[k]), (row[n : n + 3], two[k]), TOUCHES) - allowed
            if depth > deepest:
                deepest, at = depth, k
        return deepest, at

    def passes(self, q: Vector) -> bool:
        """Return whether discs without thickness pass through each other."""
        n = self.bodies[0].n_q
        poses = tuple((part[:, :3], rotations(part[:, 3:7])) for part in (q[:, :n], q[:, n:]))
        return any(len(passed(a, b, poses)) for a in self.pieces[0] for b in self.pieces[1])  # type: ignore[arg-type]


def _is_flat(pieces: list[Piece]) -> bool:
    """Return whether a body has no thickness along one of its axes."""
    widths = [farthest(piece, way) + farthest(piece, -way) for piece in pieces for way in np.eye(3)]
    return min(widths) == 0.0


def _thickness(placed: Placed) -> float:
    """Return the least width of a piece along the line [m], at least a millimetre."""
    axes = [rotations(np.array([turn]))[0].T @ placed.way for turn in placed.turns]
    widths = [
        farthest(piece, way) + farthest(piece, -way)
        for pieces, way in zip(placed.pieces, axes, strict=True)
        for piece in pieces
    ]
    return max(min(widths), 1e-3)


def _judged(placed: Placed, solution: ns.Solution, accuracy: float) -> tuple[str, str, float]:
    """Return mark, reason and relative speed of the second body of a run that came to its end."""
    v = placed.meeting.speed
    one, two = (solution.of(body)[1][-1] for body in placed.bodies)
    masses = [float(body.total_mass) for body in placed.bodies]  # type: ignore[attr-defined]
    gained = float(two[:3] @ placed.way) / v
    events = solution.events
    q = np.concatenate([solution.q, solution.q_end[None], events.q])
    depth, at = placed.depth(q)
    if depth > DEPTH:
        return "X", f"overlap of {depth:.2g} m at pose {at} of {len(q)}", gained
    if placed.passes(solution.q):
        return "X", "discs pass through each other", gained
    clearance = placed.clearance
    if clearance > DEPTH:
        if float(np.abs(two).max()) <= SPEED * v:
            return ".", "", gained
        if clearance > EDGES or not all(map(_is_flat, placed.pieces)):
            return "~", f"they pass each other {clearance:.2g} m apart", gained
    is_moved = float(np.abs(two).max()) > LEAST * v
    collides = placed.collides
    if collides and not is_moved:
        return "X", "the second body keeps its velocity", gained
    momentum = (masses[0] * one[:3] + masses[1] * two[:3]) / (masses[0] * v) - placed.way
    if float(np.abs(momentum).max()) > MOMENTUM:
        return "~", f"momentum off by {np.abs(momentum).max():.2g}", gained
    right = masses[0] * (1.0 + E) / sum(masses)
    # discs of no thickness that meet edge on may just as well pass
    if placed.is_central and collides and abs(gained - right) > accuracy:
        return "~", f"speed off by {gained - right:.2g}", gained
    if placed.instants is not None and is_moved:
        first = float(events.time[events.cause == ns.Cause.IMPACT][0])
        if not placed.instants[0] - TIME <= first <= placed.instants[1] + TIME:
            return "~", f"time of the collision off by {first - placed.instants[1]:.2g} s", gained
    return ".", "", gained


def meet(meeting: Meeting, engine: ns.EventDriven | None = None, accuracy: float = SPEED) -> Verdict:
    """Run a meeting until the first body alone would have flown twice the distance, and judge it.

    The speed after a central impact must be right to the accuracy, relative to the speed before it.
    """
    began, placed = time.process_time(), Placed.of(meeting)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            interval = 0.2 * _thickness(placed) / meeting.speed
            solution = ns.simulate(
                placed.system(), 2.0 * DISTANCE / meeting.speed, engine=engine, sample_interval=interval
            )
        except ns.NonsmoothError as error:
            return Verdict("F", f"{type(error).__name__}: {error}", seconds=time.process_time() - began)
        if solution.status != "done":
            return Verdict("F", f"{solution.status}: {solution.message}", seconds=time.process_time() - began)
        return Verdict(*_judged(placed, solution, accuracy), time.process_time() - began)
