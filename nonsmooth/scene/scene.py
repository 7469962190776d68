"""Scene: the visible parts of a system, their places over time, and the times at which a run is drawn."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np

from nonsmooth.histories.arrays import Floats
from nonsmooth.histories.replay import replay_of
from nonsmooth.interfaces import Body
from nonsmooth.interfaces.look import Look
from nonsmooth.queries.places import BodyFrames
from nonsmooth.system.contact import Tie
from nonsmooth.system.system import System

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

_FEWEST = 600
"""Fewest times at which a run is drawn: times between samples are added, so that ballistic motion is a curve."""
_SPECK = 1e-2
"""Largest size of a shape or gap that cannot be seen, relative to the extent of the shapes on its frame."""


@final
@dataclass(frozen=True, eq=False)
class FrameLook:
    """A visible shape on a frame.

    Attributes
    ----------
    frame : int
        Number of the frame, counted over all bodies.
    body : int
        Number of the body.
    look : Look
        The visible shape.
    """

    frame: int
    body: int
    look: Look


@final
@dataclass(frozen=True, eq=False)
class Stroke:
    """A line between two points that frames carry.

    Attributes
    ----------
    kind : str
        "link" of a mechanism, "load" or "joint".
    name : str
        Name of the body, load or joint.
    frames : tuple of int
        Numbers of the two frames. Numbers behind those of the frames of all bodies are ends of links.
    ends : array
        The points in their frames [m], shape [2, 3].
    """

    kind: str
    name: str
    frames: tuple[int, int]
    ends: Floats


@final
@dataclass(frozen=True, eq=False)
class Scene:
    """The visible parts of a system on their frames, and lines between frames.

    Frames are numbered body by body.  The ends of links are numbered after them, each as a frame with the axes of the
    world.

    Attributes
    ----------
    system : System
        The system.
    parts : tuple of FrameLook
        Solids, sheets, lines and marks.
    strokes : tuple of Stroke
        Links, loads and joints.
    n_frames : int
        Number of frames, including the ends of links.
    """

    system: System
    parts: tuple[FrameLook, ...]
    strokes: tuple[Stroke, ...]
    n_frames: int

    @classmethod
    def of(cls, system: System) -> Scene:
        """Scene of a system."""
        parts = list[FrameLook]()
        first, frame = dict[int, int](), 0
        for number, body in enumerate(system.bodies):
            first[id(body)] = frame
            for offset, look in _looks(body):
                parts.append(FrameLook(frame + offset, number, look))
            frame += len(body.frames)
        strokes = list[Stroke]()
        for body in system.bodies:
            for _ in range(len(body.strokes(body.state()[0]))):
                strokes.append(Stroke("link", system.name_of(body), (frame, frame + 1), np.zeros((2, 3))))
                frame += 2
        for kind, ties in (("load", system.loads), ("joint", system.joints)):
            strokes += [stroke for tie in ties for stroke in _tied(kind, tie, first, parts)]
        return cls(system, tuple(parts), tuple(strokes), frame)

    def places(self, times: Floats, q: Floats, u: Floats) -> tuple[Floats, Floats]:
        """Origins [m] and axes of all frames, shapes [n, n_frames, 3] and [n, n_frames, 3, 3].

        Parameters
        ----------
        times : array
            Times [s], shape [n].
        q, u : array
            Coordinates and velocities of all bodies, shapes [n, n_q] and [n, n_u].
        """
        n = len(times)
        origin, axes = np.zeros((n, self.n_frames, 3)), np.zeros((n, self.n_frames, 3, 3))
        axes[:] = np.eye(3)
        frame = i_q = i_u = 0
        links = sum(len(body.frames) for body in self.system.bodies)
        for body in self.system.bodies:
            own_q, own_u = q[:, i_q : i_q + body.n_q], u[:, i_u : i_u + body.n_u]
            known = BodyFrames(body, self.system.gravity)
            for i, t in enumerate(times.tolist()):
                for offset, place in enumerate(known.at(t, own_q[i], own_u[i])):
                    origin[i, frame + offset], axes[i, frame + offset] = place
            size = 2 * len(body.strokes(body.state()[0]))
            for i in range(n if size > 0 else 0):
                origin[i, links : links + size] = body.strokes(own_q[i]).reshape(-1, 3)
            frame, links = frame + len(body.frames), links + size
            i_q, i_u = i_q + body.n_q, i_u + body.n_u
        return origin, axes


def _looks(body: Body) -> Iterator[tuple[int, Look]]:
    """Frame and look of each visible shape of a body; very small shapes are merged into one hull."""
    for frame, shapes in enumerate(body.frames):
        looks = [shape.look for shape in shapes]
        reach = max((float(np.max(np.abs(look.vertices))) for look in looks if not look.sheet), default=0.0)
        specks = [look for look in looks if not look.sheet and np.max(np.ptp(look.vertices, axis=0)) <= _SPECK * reach]
        yield from ((frame, look) for look in looks if look not in specks)
        if specks:
            yield frame, Look.hull([look.vertices.mean(axis=0) for look in specks])
    yield from enumerate(body.sketch)


def _tied(kind: str, tie: Tie, first: dict[int, int], parts: Sequence[FrameLook]) -> Iterator[Stroke]:
    """Line between the ends of a load or joint.

    For a joint there is also a line from the end on a movable body to the origin of its frame, if the end is outside of
    the shapes on the frame.
    """
    bodies = tie.first, tie.second
    frames = [first[id(body)] + offset for body, offset in zip(bodies, tie.frames, strict=True)]
    yield Stroke(kind, tie.name, (frames[0], frames[1]), tie.component.ends)
    if kind == "joint":
        for body, frame, end in zip(bodies, frames, tie.component.ends, strict=True):
            if body.n_u > 0 and not _spans([part.look for part in parts if part.frame == frame], end):
                yield Stroke(kind, tie.name, (frame, frame), np.array([np.zeros(3), end]))


def _spans(looks: Sequence[Look], point: Floats) -> bool:
    """True if a box contains a point of a frame: the box about the frame's origin and all shapes on the frame."""
    seen = np.concatenate([np.zeros((1, 3)), *(look.vertices for look in looks if not look.sheet)])
    low, high = seen.min(axis=0), seen.max(axis=0)
    room = _SPECK * np.max(high - low)
    return bool(np.all((point >= low - room) & (point <= high + room)))


def knots(solution: Solution, most: int) -> Floats:
    """Times between which a run is drawn along straight lines [s], shape [n].

    These are all instants of events and at most ``most`` others, if possible samples.
    """
    samples = solution.t
    chosen = samples[:: max(1, -(-len(samples) // most))] if len(samples) > 0 else samples
    instants = np.unique(solution.events.time)
    found = np.unique(np.concatenate([chosen, samples[-1:], instants, [solution.t_end]]))
    if len(found) < min(_FEWEST, most) and replay_of(solution).is_flow:
        found = np.union1d(found, np.linspace(found[0], found[-1], min(_FEWEST, most)))
    return np.asarray(found)


def sides(system: System) -> Floats:
    """Sign of the drawn force of each contact, shape [n]: 1 for the force on the second body, -1 for that on the first.

    The force on the first body is drawn if only the first body is movable.
    """
    of_rows = [
        -1.0 if second.n_u == 0 < first.n_u else 1.0 for first, second in (r.bodies for r in system.contacts.rows)
    ]
    return system.contacts.repeated(of_rows)
