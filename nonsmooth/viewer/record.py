"""Record of a run for the player: words and arrays of bodies, events and modes."""

from __future__ import annotations

from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.modes import AFTER, BEFORE, CAUSES, CODE, DURING
from nonsmooth.histories.contacts import ClosedContacts
from nonsmooth.histories.impulses import Impulses
from nonsmooth.histories.replay import replay_of
from nonsmooth.histories.request import HistoryRequest
from nonsmooth.scene.extent import Extent, outlines
from nonsmooth.scene.scene import Scene, knots, sides

if TYPE_CHECKING:
    from nonsmooth.solution.events import Events
    from nonsmooth.solution.solution import Solution

_MOST_LETTERS = 12
"""Largest number of contacts of a system whose modes are shown as mode words; others are shown as lists of contacts."""
_MOST_NUMBERS = 6
"""Largest number of contacts that are listed by their numbers; further contacts are counted."""
_STICKS, _SLIDES, _HITS = 1, 5, 2
"""Codes of contacts in an event. A code is a sum of bits: closed 1, approaching 2, slipping 4, Eq. (29) of the paper.

A sticking contact is closed: 1. A sliding contact is closed and slips: 1 + 4. A colliding contact has the bit 2.
"""


def event_words(events: Events) -> tuple[list[str], NDArray[np.int64]]:
    """Distinct mode words, and the index of the word before, during and after each event, shape [n, 3].

    With many contacts, a word lists the closed contacts only.
    """
    rows = [_words(events, which, shift) for which, shift in (("before", BEFORE), ("during", DURING), ("after", AFTER))]
    spelled, numbers = np.unique([word for row in rows for word in row], return_inverse=True)
    return spelled.tolist(), np.asarray(numbers).reshape(3, len(events)).T


def _words(events: Events, which: str, shift: int) -> list[str]:
    if events.n_contacts <= _MOST_LETTERS:
        return events.words(which)
    bits = events.codes >> shift & CODE
    return [_spoken(events.listed[a:b], bits[a:b]) for a, b in zip(events.first[:-1], events.first[1:], strict=True)]


def _spoken(contacts: NDArray[np.int64], bits: NDArray[np.int64]) -> str:
    groups = (
        ("sticking", contacts[bits == _STICKS]),
        ("sliding", contacts[bits == _SLIDES]),
        ("colliding", contacts[bits & _HITS > 0]),
    )
    return "; ".join(f"{word} {_counted(group)}" for word, group in groups if len(group)) or "all open"


def _counted(group: NDArray[np.int64]) -> str:
    """Text with the numbers of contacts, counted from 1; only the first six if there are more."""
    said = " ".join(str(i + 1) for i in sorted(group.tolist())[:_MOST_NUMBERS])
    return said if len(group) <= _MOST_NUMBERS else f"{said} and {len(group) - _MOST_NUMBERS} more"


def event_arrays(
    solution: Solution, times: NDArray[np.float64], side: NDArray[np.float64]
) -> dict[str, tuple[str, NDArray[Any]]]:
    """Data of the events for the page: name -> (type of the numbers as in :data:`nonsmooth.viewer.page.TYPES`, array).

    ``times`` are the knots, which are the times of stored poses [s].  They include the times of all events.
    """
    # an engine that records no contacts has no events, and no impulses
    events, impulses = solution.events, Impulses.recorded(HistoryRequest(solution, times))
    sign = side[impulses.impulse_contact][:, None]
    push, rub = sign * impulses.normal_impulse[:, None] * impulses.impulse_normal, sign * impulses.friction_impulse
    return {
        "event_time": ("f8", events.time),
        "event_knot": ("i4", np.searchsorted(times, events.time)),
        "event_cause": ("u1", events.cause),
        "event_trigger": ("i4", events.contact),
        "event_first": ("i4", events.first),
        "event_contact": ("i4", events.listed),
        "event_codes": ("i2", events.codes),
        "event_point": ("f4", np.nan_to_num(impulses.impulse_point.mean(axis=1))),
        "event_push": ("f4", np.nan_to_num(push)),
        "event_rub": ("f4", np.nan_to_num(rub)),
    }


Floats = NDArray[np.float64]
Arrays = dict[str, tuple[str, NDArray[Any]]]

FORMAT = "nonsmooth-view/1"
_WHOLE = 32767
"""Integer that represents the component 1.0 of a unit quaternion: the largest signed integer of 16 bits."""
_ROOM = 250_000
"""Largest number of poses in a page, one for each frame and knot (time of stored poses), to limit its size.

With more bodies, a page has fewer knots between events.
"""


def record(solution: Solution, title: str, most_knots: int) -> tuple[dict[str, Any], Arrays]:
    """Record of a run: names, words and small tables as a dictionary for JSON, and the arrays by name."""
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
    """Unit quaternions of the axes of frames, scalar last, shape [n, n_frames, 4]."""
    from scipy.spatial.transform import Rotation

    n, n_frames = axes.shape[:2]
    return np.asarray(Rotation.from_matrix(axes.reshape(-1, 3, 3)).as_quat()).reshape(n, n_frames, 4)


def _geometry(scene: Scene, sheets: list[Floats]) -> tuple[Arrays, list[dict[str, Any]]]:
    """Arrays of vertices, triangles and lines of all drawn parts; for each part, its ranges of rows in these arrays.

    ``sheets`` are the outlines of the unbounded planes, in the order of their parts.
    """
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
    """Energy account [J] at the knots ``times`` [s], and just before the events of each instant."""
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
    """Points [m] and forces [N] of closed contacts at the knots ``times`` [s]; empty if the engine gives no forces."""
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
    found = ClosedContacts.of(HistoryRequest(solution, times))
    side = sides(solution.system)[found.contact]
    return {
        "force_first": ("i4", found.first),
        "force_contact": ("i4", found.contact),
        "force_mode": ("u1", found.mode),
        "force_point": ("f4", found.contact_point.mean(axis=1)),
        "force_push": ("f4", (side * found.normal_force)[:, None] * found.contact_normal),
        "force_rub": ("f4", side[:, None] * found.friction_force),
    }
