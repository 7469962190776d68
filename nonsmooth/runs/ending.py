"""Ending: how the calls of an engine ended."""

from __future__ import annotations

from typing import NamedTuple

from nonsmooth.model.checkpoint import Checkpoint


class Ending(NamedTuple):
    """How the calls of an engine ended.

    Attributes
    ----------
    status : int
        Last status of the engine.
    is_interrupted : bool
        The user interrupted the run.
    checkpoint : Checkpoint
        The last content of the memory that does not depend on the end time. A continued run starts there.
    n_known_events : int
        Number of events after the checkpoint, which are recorded already.
    hint : str
        What a failed run stalled at, as a sentence; "" if that is unknown.
    output_error : str
        Why results were lost, "" if none were.
    """

    status: int
    is_interrupted: bool
    checkpoint: Checkpoint
    n_known_events: int
    hint: str
    output_error: str = ""
