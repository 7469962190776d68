"""A state as the bytes of an npz file: arrays of numbers and nothing that would be executed when it is read."""

from __future__ import annotations

import dataclasses
import io
from typing import Any

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.model.checkpoint import Difference
from nonsmooth.solution.energy import EnergyAccount
from nonsmooth.solution.state import Continuation, State

_ARRAYS = tuple(field.name for field in dataclasses.fields(State) if field.name not in ("energy", "continuation"))


def state_bytes(state: State) -> bytes:
    """Return a state, with what it needs to go on, as the content of a file."""
    arrays: dict[str, Any] = {name: np.asarray(getattr(state, name)) for name in _ARRAYS}
    arrays["energy"] = np.array(dataclasses.astuple(state.energy))
    if state.continuation is not None:
        arrays["model"] = np.array(state.continuation.model)
        arrays["difference"] = np.frombuffer(state.continuation.difference.packed(), np.uint8)
        arrays["told"] = np.array(state.continuation.n_known_events)
    content = io.BytesIO()
    np.savez_compressed(content, **arrays)
    return content.getvalue()


def state_from(content: bytes, thing: str) -> State:
    """Return the state out of the content of a file, which messages call ``thing``.

    Raises
    ------
    InvalidInput
        If it is none.
    """
    try:
        with np.load(io.BytesIO(content), allow_pickle=False) as file:
            arrays = dict(file)
        energy = EnergyAccount(*arrays["energy"].tolist())
        given = {name: arrays[name] for name in _ARRAYS} | {"time": float(arrays["time"])}
        state = State(**given, energy=energy)
        if "model" in arrays:
            difference = Difference.unpacked(arrays["difference"].tobytes())
            state = state.with_continuation(Continuation(str(arrays["model"]), difference, int(arrays["told"])))
    except Exception as error:  # whatever a file of another content makes the readers raise
        raise InvalidInput(thing, "must hold a state", f"{type(error).__name__}: {error}", "It is damaged.") from error
    return state
