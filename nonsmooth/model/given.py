"""What a file says of the numbers that functions are given: the parameters, which no run changes, and the features.

Functions find their way through tables by them, so that a wrong one would be read from anywhere.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.declare import declarations
from nonsmooth.errors import InvalidInput
from nonsmooth.model.articulations import articulations
from nonsmooth.model.image import Booleans, Difference, Integers
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.pools import find_pools
from nonsmooth.system.contact import Contact

_GIVEN = (
    *(one for one in declarations(owners.DeclaredContact).values() if one.name.endswith("_parameters")),
    *(declarations(owners.DeclaredContact)[name] for name in ("inner_states_at_start", "anisotropy")),
)
_REMEDY = "It is damaged, or made up: take another."


def parameter_places(model: LaidOut) -> Integers:
    """Return the places of all parameters of functions, counted from where the blocks begin."""
    memory, contact = model.memory, owners.Contact
    given, written = np.unique(np.concatenate([starts for _, starts, _ in _given(model)])), _written(model)
    # a function without parameters leads to the block behind it
    begins = np.setdiff1d(given[given > 0], written)
    order = np.unique(np.concatenate([given, written, [memory.tables]]))
    found = _ranges(begins, order[np.searchsorted(order, begins, side="right")])
    candidates, copies, n_states = (
        memory.declared(one) for one in (contact.features, contact.inner_states_copy, contact.n_inner_states)
    )
    changing = [
        _ranges(candidates[candidates > 0], candidates[candidates > 0] + CANDIDATE + 1),
        _ranges(copies[copies > 0], (copies + n_states)[copies > 0]),
    ]
    return np.setdiff1d(found, np.concatenate(changing)) - memory.blocks


def _given(model: LaidOut) -> Iterator[tuple[str, Integers, Sequence[object]]]:
    """Yield what leads to parameters, where they begin, 0 where there are none, and whose they are."""
    system, memory = model.system, model.memory
    bodies = [f"body {name!r}" for name in system.names.bodies]
    yield "parameters", memory[owners.Body.parameters], bodies
    joints = [joint for articulation in articulations(system) for joint in articulation.joints]
    yield "parameters", memory[owners.Joint.parameters], joints
    yield "parameters", memory[owners.Load.parameters], system.loads
    yield "parameters", memory[owners.Search.parameters], [pool.owner for pool in find_pools(system.contacts)]
    yield "parameters", memory[owners.OwnGuard.parameters], system.watched
    yield "ballistic parameters", memory[owners.Body.ballistic_parameters], bodies
    for one in _GIVEN:
        yield one.name.replace("_", " "), memory[one], system.contacts


def _written(model: LaidOut) -> Integers:
    """Return where blocks begin that functions or the engine write."""
    memory, joint, contact = model.memory, owners.Articulation, owners.Contact
    found = [memory[one.out] for one in (owners.Body, owners.Joint, owners.Load, owners.Search)]
    found += [memory.declared(contact.traction_out), memory.declared(contact.rates_out)]
    ballistic = memory[owners.Body.ballistic_out]
    found.append(ballistic[ballistic > 0])
    jointed = memory[joint.n_rows] > 0
    of_joints = joint.inverse, joint.jacobian, joint.response, joint.solved_response, joint.factor
    found += [memory[one][jointed] for one in (*of_joints, joint.residual, joint.rate, joint.bias, joint.forces)]
    slots = [memory[one] for one in (contact.jacobian_a, contact.jacobian_b, contact.response_a, contact.response_b)]
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
        start, number, name, parts = max(
            (int(start), number, name, parts)
            for name, starts, parts in _given(model)
            for number, start in enumerate(starts.tolist())
            if 0 < start <= place
        )
        raise InvalidInput(
            f"State.continuation: number {place - start} of the {name} of {parts[number]}",
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
    places = model.memory.declared(owners.Contact.features)
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
