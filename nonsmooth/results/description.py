"""Writes and reads the description of a run in its folder: attributes, engine, system as text, and files of states.

A state is an npz file with arrays of numbers. Reading it executes no code of the file.
"""

from __future__ import annotations

import dataclasses
import io
import json
import math
from typing import Any

import numpy as np

from nonsmooth.errors import InvalidInput
from nonsmooth.files.components import TYPE, TomlTable, table_of
from nonsmooth.files.writing import text_of_system
from nonsmooth.histories.history import LabelledArray
from nonsmooth.interfaces import Engine
from nonsmooth.model.checkpoint import Difference
from nonsmooth.results.output import Output, versions
from nonsmooth.solution.end import RunRequest
from nonsmooth.solution.energy import EnergyAccount
from nonsmooth.solution.state import Continuation, State
from nonsmooth.system.system import System

_ARRAYS = tuple(field.name for field in dataclasses.fields(State) if field.name not in ("energy", "continuation"))


def state_bytes(state: State) -> bytes:
    """Content of a state file: the state, and the data that continue its run."""
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
    """State from the content of a state file, which messages call ``thing``.

    Raises
    ------
    InvalidInput
        The content is damaged, or not that of a state file.
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
    except Exception as error:  # damaged content can raise any error in the readers
        raise InvalidInput(thing, "must hold a state", f"{type(error).__name__}: {error}", "It is damaged.") from error
    return state


UNFINISHED = "unfinished"
"""Status of a run that is under way, or was cut off."""
MESSAGE = "the run goes on, or it was cut off and `nonsmooth resume` goes on with it"
"""Message of an unfinished run."""


def attributes_of(output: Output, engine: Engine, request: RunRequest) -> dict[str, Any]:
    """Attributes of the folder of results at the beginning of a run."""
    known = versions()
    return {
        "Conventions": "CF-1.11",
        "title": output.title,
        "source": f"nonsmooth {known['nonsmooth']}",
        "status": UNFINISHED,
        "message": MESSAGE,
        "t_end_asked": request.t_end,
        "sample_start": request.sample_start,
        "sample_interval": request.sample_interval,
        "default_samples": int(request.has_default_samples),
        "conditional": int(request.is_conditional),
        "engine": json.dumps(_table(engine)),
        "records_contacts": int(engine.records_contacts),
        "versions": json.dumps(dict(known)),
        "request": json.dumps(dict(output.request)),
        "parameters": json.dumps(dict(output.parameters)),
    }


def _table(engine: Engine) -> TomlTable:
    """Table of an engine: its installed name and options.

    An engine that cannot be written to a file, such as a class of a script, gets other entries: "module:Class" in
    place of the installed name, and the options as text.
    """
    try:
        return table_of(engine, "engine")
    except InvalidInput:
        options = {name: repr(value) for name, value in vars(engine).items()}
        return {TYPE: f"{type(engine).__module__}:{type(engine).__qualname__}", **options}


def named_elsewhere(table: TomlTable) -> bool:
    """True if the table of an engine names a class in Python and not an installed engine."""
    return ":" in str(table.get(TYPE))


def system_variable(
    system: System, output: Output, engine: Engine, t_end: float, attributes: dict[str, Any]
) -> LabelledArray:
    """Text of the system as a scenario file, "" if a file cannot hold it; ``system_missing`` then gives the reason.

    An engine that a file cannot name is left out of the text.  The attribute ``engine`` of the folder describes it.
    """
    named = None if named_elsewhere(_table(engine)) else engine
    try:
        text = text_of_system(system, t_end=t_end, engine=named, title=output.title)
    except InvalidInput as error:
        text, attributes["system_missing"] = "", f"{error.thing} {error.rule}; it is {error.value!r}"
    return LabelledArray("system", (), np.array(text), {"long_name": "the system as a scenario file, TOML"})


def energies(state: State) -> dict[str, float]:
    """Energy account [J] and its residual, without infinite and undefined values, for which JSON has no numbers."""
    account = {**vars(state.energy), "energy_residual": state.energy.residual}
    return {name: value for name, value in account.items() if math.isfinite(value)}
