"""Arrays of a solution with their axes and units, in memory and on disk: tables of samples and of events."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.datasets import described
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.memory.modes import AFTER, BEFORE, CAUSES, CODE, DURING
from nonsmooth.histories import history
from nonsmooth.histories.history import LabelledArray
from nonsmooth.solution.events import ENERGIES, Events, ReadRows
from nonsmooth.system.names import labels
from nonsmooth.system.system import System

if TYPE_CHECKING:
    import xarray

    from nonsmooth.solution.solution import Solution

Floats = NDArray[np.float64]
GROWING = ("time", "event", "listing")
"""Dimensions along which results grow: samples, events, and the contacts listed with events, one after another."""
_ACCOUNT = {
    "units": "J",
    "long_name": "energies since the start",
    "account_names": "work of driven bodies, loss to friction, gross exchange, work of loads, loss in closing",
}
_INNER = {"long_name": "inner states of friction and traction laws, contact by contact, in SI units of each law"}
_BOOKED = {
    "units": "J",
    "long_name": "energies accounted at instants since the start",
    "booked_names": ", ".join(ENERGIES),
}
_MEMORY = (
    ("first part of the slip direction", "1"),
    ("second part of the slip direction", "1"),
    ("rate of closing", "m/s"),
    ("slip direction that an oriented law faces", "1"),
    ("mode after the time-stepping fallback", "1"),
    *((f"feature {number}", "1") for number in range(CANDIDATE)),
)
"""Names and units of the columns of ``Events.listed_memory``, which a contact keeps for a continued run."""
_MODE: dict[str, Any] = {"flag_masks": [1, 2, 4], "flag_meanings": "closed approaching slipping"}
_SHIFTS = {"mode_before": BEFORE, "mode_during": DURING, "mode_after": AFTER}
_CAUSE: dict[str, Any] = {
    "flag_values": list(range(len(CAUSES))),
    "flag_meanings": " ".join(cause.replace(" ", "_") for cause in CAUSES),
}


def _words(name: str, dimension: str, words: Sequence[str], what: str) -> LabelledArray:
    return LabelledArray.of(name, (dimension,), np.array(words, dtype=str), what)


def of_system(system: System) -> list[LabelledArray]:
    """Arrays of labels for results: names of bodies, coordinates, contacts and guards, laws of the contacts."""
    names, contacts = system.names, system.contacts
    known = dict(zip(map(id, system.bodies), names.bodies, strict=True))
    found = [
        _words("body", "body", names.bodies, "body"),
        _words("body_kind", "body", [type(body).__name__ for body in system.bodies], "class of the body"),
    ]
    rows_of = labels(system)
    for dimension, rows in (("coordinate", rows_of.coordinates), ("velocity", rows_of.velocities)):
        bodies, label, unit = zip(*rows, strict=True) if rows else ((), (), ())
        found += [
            _words(dimension, dimension, label, f"{dimension} of a body"),
            _words(f"{dimension}_body", dimension, bodies, "body that it belongs to"),
            _words(f"{dimension}_units", dimension, unit, "its unit"),
        ]
    found += [_words(kind, kind, words, kind) for kind, words in (("contact", names.contacts), ("guard", names.guards))]
    for which in ("first", "second"):
        between = [known[id(getattr(contact, which))] for contact in contacts]
        found.append(_words(f"contact_{which}_body", "contact", between, f"{which} body of the contact"))
    for role in ("normal", "friction", "impact"):
        laws = [getattr(contact, role) for contact in contacts]
        # contacts share laws; the text of each law is made once, because that takes longer than a look-up by id()
        words = {key: repr(law) for key, law in {id(law): law for law in laws}.items()}
        texts = [words[id(law)] for law in laws]
        found.append(_words(f"contact_{role}", "contact", texts, f"law of the contact: {role}"))
    directions = ("normal", "first tangent", "second tangent")
    return [*found, _words("direction", "direction", directions, "direction at a contact")]


def of_memory() -> list[LabelledArray]:
    """Names and units of the columns of ``Events.listed_memory``, as labelled arrays."""
    names, units = zip(*_MEMORY, strict=True)
    return [
        _words("of_memory", "of_memory", names, "state that a contact keeps"),
        _words("of_memory_units", "of_memory", units, "its unit"),
    ]


_SAMPLES: tuple[tuple[str, tuple[str, ...], dict[str, Any]], ...] = (
    ("time", ("time",), {"units": "s", "standard_name": "time", "axis": "T", "long_name": "time"}),
    ("q", ("time", "coordinate"), described("coordinates of all bodies, see coordinate_units")),
    ("u", ("time", "velocity"), described("velocities of all bodies, see velocity_units")),
    ("account", ("time", "of_account"), _ACCOUNT),
    ("law_state", ("time", "of_law_state"), _INNER),
    ("booked", ("time", "of_booked"), _BOOKED),
)
"""Arrays of samples: name, dimensions and attributes."""
SAMPLES = tuple(name for name, *_ in _SAMPLES)
"""Names of the arrays of samples, in the order in which a row of numbers holds a sample."""


def of_samples(*values: Floats) -> list[LabelledArray]:
    """Labelled arrays of the samples; ``values`` are in the order of :data:`SAMPLES` and may lack the last ones."""
    return [LabelledArray(name, over, array, more) for (name, over, more), array in zip(_SAMPLES, values, strict=False)]


@final
@dataclass(frozen=True)
class _StoredArray:
    """A stored array of events: a row of the tables below.

    Attributes
    ----------
    name : str
        Name of the array.
    dimensions : tuple of str
        Names of its axes.
    attributes : mapping
        Description, unit and other attributes.
    values : callable
        Function that computes the array from events.
    column : str
        Column of the events that it holds, "" if it holds a part or a function of a column.
    kind : type
        Type of its numbers in a file.
    """

    name: str
    dimensions: tuple[str, ...]
    attributes: Mapping[str, Any]
    values: Callable[[Events], NDArray[Any]]
    column: str = ""
    kind: type[np.number[Any]] = np.float64

    def of(self, events: Events) -> LabelledArray:
        """Labelled array with the values of this row for some events."""
        values = np.asarray(self.values(events), self.kind)
        return LabelledArray(self.name, self.dimensions, values, self.attributes)


def _column(
    name: str, axes: str, column: str, what: str, unit: str = "1", kind: type[np.number[Any]] = np.float64, **more: Any
) -> _StoredArray:
    """Entry of the table of stored arrays for the array ``name``, which holds the attribute ``column`` of Events.

    The unit "" means that another array holds the unit of each entry.
    """
    attributes = {**described(what, unit), **more}
    return _StoredArray(name, tuple(axes.split()), attributes, attrgetter(column), column, kind)


def _mode(name: str, shift: int) -> _StoredArray:
    """Entry of the table of stored arrays for the contacts' mode bits before, during or after events.

    These are the bits of ``Events.codes`` from bit ``shift`` on.
    """
    attributes = {**described(f"mode of the contact {name.removeprefix('mode_')} the event", "1"), **_MODE}
    return _StoredArray(name, ("listing",), attributes, lambda events: events.codes >> shift & CODE, kind=np.uint8)


_SIZE = {**described("contacts listed", "1"), "sample_dimension": "listing"}
_EVENTS = (
    _column("event_time", "event", "time", "time of the event", "s", standard_name="time"),
    _column("event_cause", "event", "cause", "cause", kind=np.int8, **_CAUSE),
    _column("event_contact", "event", "contact", "index in `contact` or, by its cause, `guard`, from 0", kind=np.int32),
    _column("event_phases", "event", "phases", "changes of phase within the impact", kind=np.int32),
    _column("event_truncated", "event", "truncated", "1 where an endless cascade was cut short", kind=np.int8),
    _column("driven_work", "event", "driven_work", "work of driven bodies in the event", "J"),
    _column("restitution_loss", "event", "restitution_loss", "loss to restitution in the event", "J"),
    _column("friction_loss", "event", "friction_loss", "loss to friction in the event", "J"),
    _column("closing_loss", "event", "closing_loss", "loss in closing steps and projections of the event", "J"),
    _column("event_q", "event coordinate", "q", "coordinates at the event, see coordinate_units", ""),
    _column("event_u_before", "event velocity", "u_before", "velocities before the event, see velocity_units", ""),
    _column("event_u_after", "event velocity", "u_after", "velocities after the event, see velocity_units", ""),
    _StoredArray("event_size", ("event",), _SIZE, lambda events: np.diff(events.first), kind=np.int32),
    _column("listed_contact", "listing", "listed", "index in `contact`, from 0", kind=np.int32),
    *(_mode(name, shift) for name, shift in _SHIFTS.items()),
    _column("impulse", "listing direction", "listed_impulse", "impulse of the contact in the event", "N s"),
)
"""Stored arrays of events.

Arrays over "listing" have one row for each contact of each event, one event after the other: event i has the next
``event_size[i]`` rows.
"""
_CONTINUED = (
    _StoredArray("event_account", ("event", "of_account"), _ACCOUNT, lambda events: events.integrated[:, :N_ACCOUNTS]),
    _StoredArray(
        "event_law_state", ("event", "of_law_state"), _INNER, lambda events: events.integrated[:, N_ACCOUNTS:]
    ),
    _StoredArray("event_booked", ("event", "of_booked"), _BOOKED, attrgetter("booked"), "booked"),
    _column(
        "listed_memory", "listing of_memory", "listed_memory", "state that a contact keeps, see of_memory_units", ""
    ),
)
"""Further arrays of events, which are needed only to continue a run."""
_OF_COLUMN = {row.column: row for row in (*_EVENTS, *_CONTINUED) if row.column}


def of_events(events: Events) -> list[LabelledArray]:
    """Times, causes, energies, states and listed contacts of events."""
    return [row.of(events) for row in _EVENTS]


def of_all_of_events(events: Events) -> list[LabelledArray]:
    """All columns of events, from which :func:`stored_events` makes them again."""
    return [row.of(events) for row in (*_EVENTS, *_CONTINUED)]


def stored_events(read: ReadRows, n: int, n_contacts: int) -> Events:
    """Events from their stored arrays; each column is read when it is needed.

    Parameters
    ----------
    read : callable
        ``read(name, start, stop)`` reads rows of a stored array; with ``stop`` None, to the end of the array.
    n : int
        Number of events.
    n_contacts : int
        Number of contacts of the system.
    """

    def column(name: str, start: int, stop: int | None) -> NDArray[Any]:
        if name in _OF_COLUMN:
            row = _OF_COLUMN[name]
            return read(row.name, start, stop).astype(np.float64 if row.kind is np.float64 else np.int64, copy=False)
        if name == "integrated":
            return np.hstack([read("event_account", start, stop), read("event_law_state", start, stop)])
        if name == "codes":
            bits = [read(name, start, stop).astype(np.int64) << shift for name, shift in _SHIFTS.items()]
            return np.asarray(np.sum(bits, axis=0))
        sizes = read("event_size", 0, None).astype(np.int64)
        return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)[start:stop]

    return Events(n, n_contacts, column)


def to_dataset(solution: Solution) -> xarray.Dataset:
    """Samples and events of a solution as one dataset (:meth:`nonsmooth.Solution.to_xarray`)."""
    samples = of_samples(solution.t, solution.q, solution.u)
    attributes = vars(solution.energy) | {
        "Conventions": "CF-1.11",
        "status": str(solution.status),
        "message": solution.message,
        "t_end": solution.t_end,
        "energy_residual": solution.energy.residual,
    }
    return history.to_dataset([*of_system(solution.system), *samples, *of_events(solution.events)], (), attributes)
