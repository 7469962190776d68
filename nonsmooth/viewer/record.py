"""Record of a run for the player: words and arrays."""

from __future__ import annotations

from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.modes import CAUSES
from nonsmooth.histories.contacts import ClosedContacts
from nonsmooth.histories.replay import replay_of
from nonsmooth.histories.request import Request
from nonsmooth.scene.extent import Extent, outlines
from nonsmooth.scene.scene import Scene, knots, sides
from nonsmooth.viewer.events import event_arrays, event_words

if TYPE_CHECKING:
    from nonsmooth.solution.solution import Solution

Floats = NDArray[np.float64]
Arrays = dict[str, tuple[str, NDArray[Any]]]

FORMAT = "nonsmooth-view/1"
_WHOLE = 32767
"""Integer that represents the component 1 of a quaternion."""
_ROOM = 250_000
"""Largest number of poses; more bodies have fewer knots between events."""


def record(solution: Solution, title: str, most_knots: int) -> tuple[dict[str, Any], Arrays]:
    """Words and arrays of a run."""
    system, scene = solution.system, Scene.of(solution.system)
    times = knots(solution, max(2, min(most_knots, _ROOM // max(1, scene.n_frames))))
    states = solution.at(times)
    origin, axes = scene.places(times, states["q"], states["u"])
    extent = Extent.of(scene, origin, axes)
    geometry, parts = _geometry(scene, outlines(scene, origin, axes, extent))
    words, numbers = event_words(solution.events)
    arrays: Arrays = {
        "time": ("f8", times),
        "origin": ("f4", origin),
        "turn": ("i2", np.rint(_WHOLE * _turns(axes))),
        **geometry,
        **_energies(solution, times),
        **event_arrays(solution, times, sides(system)),
        "event_words": ("i4", numbers),
        **_forces(solution, times),
    }
    names = system.names
    told = {
        "format": FORMAT,
        "version": version("nonsmooth"),
        "title": title,
        "status": str(solution.status),
        "message": solution.message,
        "bodies": [
            {"name": name, "moves": body.n_u > 0} for name, body in zip(names.bodies, system.bodies, strict=True)
        ],
        "contacts": [{"name": name} for name in names.contacts],
        "guards": list(names.guards),
        "causes": list(CAUSES),
        "words": words,
        "parts": parts,
        "strokes": [
            {"kind": one.kind, "name": one.name, "frames": one.frames, "ends": one.ends.tolist()}
            for one in scene.strokes
        ],
        "low": extent.low.tolist(),
        "high": extent.high.tolist(),
        "reach": extent.reach,
    }
    return told, arrays


def _turns(axes: Floats) -> Floats:
    """Unit quaternions, scalar last, shape [n, n_frames, 4]."""
    from scipy.spatial.transform import Rotation

    n, n_frames = axes.shape[:2]
    return np.asarray(Rotation.from_matrix(axes.reshape(-1, 3, 3)).as_quat()).reshape(n, n_frames, 4)


def _geometry(scene: Scene, sheets: list[Floats]) -> tuple[Arrays, list[dict[str, Any]]]:
    """Arrays of all looks, and the ranges of each part in them; ``sheets`` are outlines."""
    looks = [part.look for part in scene.parts]
    firsts = np.cumsum([0, *(len(look.vertices) for look in looks)])
    parts = list[dict[str, Any]]()
    outline = iter(sheets)
    counts = {"triangles": 0, "lines": 0}
    for part, first, last in zip(scene.parts, firsts[:-1].tolist(), firsts[1:].tolist(), strict=True):
        look = part.look
        told = {"frame": part.frame, "body": part.body, "vertices": [first, last]}
        told["sheet"] = next(outline).tolist() if look.sheet else None
        for name, rows in (("triangles", look.triangles), ("lines", look.lines)):
            told[name] = [counts[name], counts[name] + len(rows)]
            counts[name] += len(rows)
        parts.append(told)
    arrays: Arrays = {
        "vertices": ("f4", np.concatenate([np.zeros((0, 3)), *(look.vertices for look in looks)])),
        "triangles": ("i4", np.concatenate([np.zeros((0, 3)), *(look.triangles for look in looks)])),
        "lines": ("i4", np.concatenate([np.zeros((0, 2)), *(look.lines for look in looks)])),
    }
    return arrays, parts


def _energies(solution: Solution, times: Floats) -> Arrays:
    """Energy account at the knots, and before the events of each instant."""
    losses, works = ("restitution_loss", "friction_loss", "closing_loss"), ("driven_work", "load_work")
    found = solution.history("kinetic_energy", "potential_energy", *losses, *works, times=times)
    kinetic, potential, restitution, friction, closing, driven, loads = found.values()
    after = np.column_stack([kinetic, potential, restitution, friction + closing, driven + loads])
    events = solution.events
    instants, number = np.unique(events.time, return_inverse=True)
    lost = events.restitution_loss, events.friction_loss + events.closing_loss, events.driven_work
    restitution, friction, work = (np.bincount(number, one, len(instants)) for one in lost)
    knot = np.searchsorted(times, instants)
    before = after[knot] - np.column_stack([work - restitution - friction, 0.0 * work, restitution, friction, work])
    return {"energy": ("f4", after), "instant_knot": ("i4", knot), "energy_before": ("f4", before)}


def _forces(solution: Solution, times: Floats) -> Arrays:
    """Forces of closed contacts at the knots; empty arrays if the engine gives no forces."""
    if not replay_of(solution).is_flow:
        none, nowhere = np.zeros(0), np.zeros((0, 3))
        return {
            "force_first": ("i4", np.zeros(2)),
            "force_contact": ("i4", none),
            "force_mode": ("u1", none),
            "force_point": ("f4", nowhere),
            "force_push": ("f4", nowhere),
            "force_rub": ("f4", nowhere),
        }
    found = ClosedContacts.of(Request(solution, times))
    side = sides(solution.system)[found.contact]
    return {
        "force_first": ("i4", found.first),
        "force_contact": ("i4", found.contact),
        "force_mode": ("u1", found.mode),
        "force_point": ("f4", found.contact_point.mean(axis=1)),
        "force_push": ("f4", (side * found.normal_force)[:, None] * found.contact_normal),
        "force_rub": ("f4", side[:, None] * found.friction_force),
    }
