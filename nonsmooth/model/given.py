"""What a file says of the numbers that functions are given: the parameters, which no run changes, and the features.

Functions find their way through tables by them, so that a wrong one would be read from anywhere.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.layout import CATALOGUE
from nonsmooth.errors import InvalidInput
from nonsmooth.model.articulations import articulations
from nonsmooth.model.image import Booleans, Difference, Integers
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.pools import find_pools
from nonsmooth.system.contact import Contact

_GIVEN = (*(name for name in CATALOGUE if name.endswith("_parameters")), "state_start", "axis")
_WRITTEN = ("traction_out", "rates_out")
_OF_JOINTS = ("inverse", "jacobian", "r", "y", "factor", "residual", "rate", "bias", "x")
_OF_SLOTS = ("jacobian_a", "jacobian_b", "response_a", "response_b")
_REMEDY = "It is damaged, or made up: take another."


def parameter_places(model: LaidOut) -> Integers:
    """Return the places of all parameters of functions, counted from where the blocks begin."""
    memory, rows = model.memory, _rows(model)
    given, written = np.unique(np.concatenate([starts for _, starts, _ in _given(model)])), _written(model, rows)
    # a function without parameters leads to the block behind it
    begins = np.setdiff1d(given[given > 0], written)
    order = np.unique(np.concatenate([given, written, [memory.tables]]))
    found = _ranges(begins, order[np.searchsorted(order, begins, side="right")])
    candidates, copies, n_states = (rows[:, CATALOGUE.index(name)] for name in ("candidate", "state_copy", "n_state"))
    changing = [
        _ranges(candidates[candidates > 0], candidates[candidates > 0] + CANDIDATE + 1),
        _ranges(copies[copies > 0], (copies + n_states)[copies > 0]),
    ]
    return np.setdiff1d(found, np.concatenate(changing)) - memory.blocks


def _rows(model: LaidOut) -> Integers:
    n = len(model.system.contacts)
    return model.memory.array("catalogue", len(CATALOGUE) * n).reshape(n, len(CATALOGUE))


def _given(model: LaidOut) -> Iterator[tuple[str, Integers, Sequence[object]]]:
    """Yield what leads to parameters, where they begin, 0 where there are none, and whose they are."""
    system, memory, rows = model.system, model.memory, _rows(model)
    owners: dict[str, Sequence[object]] = {
        "body": [f"body {name!r}" for name in system.names.bodies],
        "joint": [joint for articulation in articulations(system) for joint in articulation.joints],
        "load": system.loads,
        "pool": [pool.owner for pool in find_pools(system.contacts)],
        "own_guard": system.watched,
    }
    for kind, parts in owners.items():
        yield "parameters", memory.array(f"{kind}_parameters", len(parts)), parts
    yield "parameters in flight", memory.array("body_flight_parameters", len(system.bodies)), owners["body"]
    for name in _GIVEN:
        yield name.replace("_", " "), rows[:, CATALOGUE.index(name)], system.contacts


def _written(model: LaidOut, rows: Integers) -> Integers:
    """Return where blocks begin that functions or the engine write."""
    memory, s = model.memory, model.memory.scalars[0]
    counts = {"body": "n_bodies", "joint": "n_joints", "load": "n_loads", "pool": "n_pools"}
    found = [memory.array(f"{kind}_out", int(s[count])) for kind, count in counts.items()]
    found += [rows[:, CATALOGUE.index(name)] for name in _WRITTEN]
    flights = memory.array("body_flight_out", int(s["n_bodies"]))
    found.append(flights[flights > 0])
    n = int(s["n_articulations"])
    jointed = memory.array("articulation_rows", n) > 0
    found += [memory.array(f"articulation_{name}", n)[jointed] for name in _OF_JOINTS]
    slots = [memory.array(name, int(s["n_slots"])) for name in _OF_SLOTS]
    # without coordinates they have no length
    return np.unique(np.concatenate(found + (slots if len(np.unique(slots)) > 1 else [])))


def _ranges(begins: Integers, ends: Integers) -> Integers:
    """Return all numbers from each begin up to its end."""
    return np.concatenate([np.arange(begin, end) for begin, end in zip(begins, ends, strict=True)] or [begins])


def check_parameters(model: LaidOut, difference: Difference, others: Booleans) -> None:
    """Look whether what a file says differs is no parameter of a function; ``others`` tells it of each place.

    Raises
    ------
    InvalidInput
        If it does not.
    """
    wrong = np.flatnonzero(~others[difference.places[2]])
    if len(wrong) > 0:
        at, said = int(difference.places[2][wrong[0]]), float(difference.bits[2][wrong[:1]].view(np.float64)[0])
        place = model.memory.blocks + at
        start, number, name, owners = max(
            (int(start), number, name, owners)
            for name, starts, owners in _given(model)
            for number, start in enumerate(starts.tolist())
            if 0 < start <= place
        )
        raise InvalidInput(
            f"State.continuation: number {place - start} of the {name} of {owners[number]}",
            f"must be {float(model.memory.floats[place]):.9g}, as the model has it",
            said,
            _REMEDY,
        )


def check_candidates(model: LaidOut) -> None:
    """Look whether the contacts of pools hold pairs of features that there are.

    Raises
    ------
    InvalidInput
        If one does not.
    """
    places = _rows(model)[:, CATALOGUE.index("candidate")]
    numbers = np.flatnonzero(places > 0)
    for number in numbers[model.memory.floats[places[numbers]] != 0.0].tolist():
        contact = model.system.contacts[number]
        kind, *held, apart = model.memory.floats[places[number] :][: CANDIDATE + 1].tolist()
        if not (_are_features(contact, kind, held) and 0.0 <= apart < np.inf):
            raise InvalidInput(
                f"State.continuation: the features of the {contact}",
                f"must be those of {_told(contact)}, and up to some distance",
                (kind, *held, apart),
                _REMEDY,
            )


def _are_features(contact: Contact, kind: float, held: list[float]) -> bool:
    search = contact.kinematics.candidates
    assert search is not None
    counts = search.counts.get(kind, (0, 0))
    return all(number.is_integer() and 0 <= number < count for number, count in zip(held, counts, strict=True))


def _told(contact: Contact) -> str:
    search = contact.kinematics.candidates
    assert search is not None
    kinds = [f"({kind:g}, below {one}, below {two})" for kind, (one, two) in search.counts.items()]
    return " or ".join(kinds)
