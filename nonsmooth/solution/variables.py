"""Arrays of a solution with their axes and units, the same in memory and on disk."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.layout import N_ACCOUNTS
from nonsmooth.engine.memory.modes import AFTER, BEFORE, CAUSES, CODE, DURING
from nonsmooth.histories import history
from nonsmooth.histories.history import LabelledArray
from nonsmooth.solution.events import Events, ReadRows
from nonsmooth.system.labels import labels
from nonsmooth.system.system import System

if TYPE_CHECKING:
    import xarray

    from nonsmooth.solution.solution import Solution

Floats = NDArray[np.float64]
GROWING = ("time", "event", "listing")
"""Dimensions along which results grow: samples, events, and the contacts listed with them one after another."""
_ENERGIES = {
    "driven_work": "work of driven bodies in the event",
    "restitution_loss": "loss to restitution in the event",
    "friction_loss": "loss to friction in the event",
    "closing_loss": "loss in closing steps and projections of the event",
}
_ACCOUNTS = ("work of driven bodies", "loss to friction", "gross exchange", "work of loads")
_ACCOUNT = {"units": "J", "long_name": "energies since the start", "account_names": ", ".join(_ACCOUNTS)}
_INNER = {"long_name": "inner states of friction and traction laws, contact by contact, in SI units of each law"}
_BOOKED = {
    "units": "J",
    "long_name": "energies booked at instants since the start",
    "booked_names": ", ".join(_ENERGIES),
}
_MEMORY = {"long_name": "what the contact goes on with, see of_memory_units"}
_REMEMBERED = (
    ("first part of the slip direction", "1"),
    ("second part of the slip direction", "1"),
    ("rate of closing", "m/s"),
    ("way of slip that an oriented law faces", "1"),
    ("mode in which its averaged forces end", "1"),
    *((f"feature {number}", "1") for number in range(CANDIDATE)),
)
_MODE: dict[str, Any] = {"flag_masks": [1, 2, 4], "flag_meanings": "closed approaching slipping"}
_SHIFTS = {"mode_before": BEFORE, "mode_during": DURING, "mode_after": AFTER}


def of_system(system: System) -> list[LabelledArray]:
    """Return the labels of bodies, coordinates and contacts, and the laws of the latter."""
    names, rows_of, contacts = system.names, labels(system), system.contacts
    known = dict(zip(map(id, system.bodies), names.bodies, strict=True))
    found = [
        _words("body", "body", names.bodies, "body"),
        _words("body_kind", "body", [type(body).__name__ for body in system.bodies], "class of the body"),
    ]
    for dimension, rows in (("coordinate", rows_of.coordinates), ("velocity", rows_of.velocities)):
        whose, label, unit = zip(*rows, strict=True) if rows else ((), (), ())
        found += [
            _words(dimension, dimension, label, f"{dimension} of a body"),
            _words(f"{dimension}_body", dimension, whose, "body that it belongs to"),
            _words(f"{dimension}_units", dimension, unit, "its unit"),
        ]
    found.append(_words("contact", "contact", names.contacts, "contact"))
    found.append(_words("guard", "guard", names.guards, "guard"))
    for which in ("first", "second"):
        between = [known[id(getattr(contact, which))] for contact in contacts]
        found.append(_words(f"contact_{which}_body", "contact", between, f"{which} body of the contact"))
    for role in ("normal", "friction", "impact"):
        laws = [getattr(contact, role) for contact in contacts]
        words = {key: repr(law) for key, law in {id(law): law for law in laws}.items()}
        found.append(
            _words(f"contact_{role}", "contact", [words[id(law)] for law in laws], f"law of the contact: {role}")
        )
    directions = ("normal", "first tangent", "second tangent")
    return [*found, _words("direction", "direction", directions, "direction at a contact")]


def of_memory() -> list[LabelledArray]:
    """Return names and units of what a contact goes on with."""
    names, units = zip(*_REMEMBERED, strict=True)
    return [
        _words("of_memory", "of_memory", names, "what a contact goes on with"),
        _words("of_memory_units", "of_memory", units, "its unit"),
    ]


def _words(name: str, dimension: str, words: Sequence[str], what: str) -> LabelledArray:
    return LabelledArray.of(name, (dimension,), np.array(words, dtype=str), what)


def of_samples(t: Floats, q: Floats, u: Floats) -> list[LabelledArray]:
    """Return samples."""
    return [
        LabelledArray("time", ("time",), t, {"units": "s", "standard_name": "time", "axis": "T", "long_name": "time"}),
        _over("q", ("time", "coordinate"), q, "coordinates of all bodies"),
        _over("u", ("time", "velocity"), u, "velocities of all bodies"),
    ]


def _over(name: str, dimensions: tuple[str, str], values: Floats, what: str) -> LabelledArray:
    return LabelledArray.of(name, dimensions, values, f"{what}, see {dimensions[1]}_units")


def of_rest_of_samples(accounts: Floats, law_states: Floats, booked: Floats) -> list[LabelledArray]:
    """Return what a run has besides coordinates and velocities: energies and inner states of laws."""
    return [
        LabelledArray("account", ("time", "of_account"), accounts, _ACCOUNT),
        LabelledArray("law_state", ("time", "of_law_state"), law_states, _INNER),
        LabelledArray("booked", ("time", "of_booked"), booked, _BOOKED),
    ]


def of_rest_of_events(events: Events) -> list[LabelledArray]:
    """Return the same at events, and what the contacts listed with them go on with."""
    accounts, law_states = np.split(events.integrated, [N_ACCOUNTS], axis=1)
    return [
        LabelledArray("event_account", ("event", "of_account"), accounts, _ACCOUNT),
        LabelledArray("event_law_state", ("event", "of_law_state"), law_states, _INNER),
        LabelledArray("event_booked", ("event", "of_booked"), events.booked, _BOOKED),
        LabelledArray("listed_memory", ("listing", "of_memory"), events.listed_memory, _MEMORY),
    ]


def of_events(events: Events) -> list[LabelledArray]:
    """Return events, and the contacts listed with them as a contiguous ragged array: ``event_size`` of each event."""

    def over(name: str, values: NDArray[Any], what: str, units: str = "1", **more: Any) -> LabelledArray:
        return LabelledArray.of(name, ("event",), values, what, units, **more)

    def listed(name: str, values: NDArray[Any], what: str, **more: Any) -> LabelledArray:
        return LabelledArray.of(name, ("listing",), values, what, "1", **more)

    causes: dict[str, Any] = {
        "flag_values": list(range(len(CAUSES))),
        "flag_meanings": " ".join(c.replace(" ", "_") for c in CAUSES),
    }
    bits = {name: (events.codes >> shift & CODE).astype(np.uint8) for name, shift in _SHIFTS.items()}
    return [
        over("event_time", events.time, "time of the event", "s", standard_name="time"),
        over("event_cause", events.cause.astype(np.int8), "cause", **causes),
        over(
            "event_contact",
            events.contact.astype(np.int32),
            "index in `contact` or, by its cause, `guard`, from 0",
        ),
        over("event_phases", events.phases.astype(np.int32), "changes of phase within the impact"),
        over("event_truncated", events.truncated.astype(np.int8), "1 where an endless cascade was cut short"),
        *(over(name, getattr(events, name), what, "J") for name, what in _ENERGIES.items()),
        _over("event_q", ("event", "coordinate"), events.q, "coordinates at the event"),
        _over("event_u_before", ("event", "velocity"), events.u_before, "velocities before the event"),
        _over("event_u_after", ("event", "velocity"), events.u_after, "velocities after the event"),
        over("event_size", np.diff(events.first).astype(np.int32), "contacts listed", sample_dimension="listing"),
        listed("listed_contact", events.listed.astype(np.int32), "index in `contact`, from 0"),
        *(listed(name, bits[name], f"mode of the contact {name[5:]} the event", **_MODE) for name in _SHIFTS),
        LabelledArray.of(
            "impulse",
            ("listing", "direction"),
            events.listed_impulse,
            "impulse of the contact in the event",
            "N s",
        ),
    ]


_FLOATS = {"time": "event_time", "q": "event_q", "u_before": "event_u_before", "u_after": "event_u_after"}
_FLOATS |= {name: name for name in (*_ENERGIES, "listed_memory")}
_FLOATS |= {"booked": "event_booked", "listed_impulse": "impulse"}
_INTEGERS = {name: f"event_{name}" for name in ("cause", "contact", "phases", "truncated")}
_INTEGERS |= {"listed": "listed_contact"}
"""Stored arrays of the columns of events."""


def stored_events(read: ReadRows, n: int, n_contacts: int) -> Events:
    """Events out of their stored arrays; each column is read when it is needed.

    Parameters
    ----------
    read : callable
        ``read(name, start, stop)`` reads rows of a stored array; the stop None is its end.
    n : int
        Number of events.
    n_contacts : int
        Number of contacts of the system.
    """

    def column(name: str, start: int, stop: int | None) -> NDArray[Any]:
        if name in _FLOATS:
            return read(_FLOATS[name], start, stop)
        if name in _INTEGERS:
            return read(_INTEGERS[name], start, stop).astype(np.int64)
        if name == "integrated":
            return np.hstack([read("event_account", start, stop), read("event_law_state", start, stop)])
        if name == "codes":
            bits = [read(name, start, stop).astype(np.int64) << shift for name, shift in _SHIFTS.items()]
            return np.asarray(np.sum(bits, axis=0))
        sizes = read("event_size", 0, None).astype(np.int64)
        return np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)[start:stop]

    return Events.lazy(n, n_contacts, column)


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
