"""How a run of a study ended, as numbers that a store keeps."""

from __future__ import annotations

import re

from nonsmooth.engine.memory import modes

NOT_RUN, DONE, FAILED, BUDGET, CRASHED, SUSPECT = range(6)
STATUSES = ("not_run", "done", "failed", "budget", "crashed", "suspect")
"""Their names; a suspect run reached its end, but its own checks found something."""
VALUED = (DONE, SUSPECT)
"""Runs of these have records."""

WORKER_DIED, RAISED, UNKNOWN = -2, -1, 0
"""Reasons that are none of the engine: the process of the run died, it raised something, it has not run."""


def reason_of(message: str) -> int:
    """Return the engine's code for why a run ended, by the sentence that says so."""
    return next((code for code, sentence in modes.REASONS.items() if sentence in message), RAISED)


def reason_attributes() -> dict[str, object]:
    """Return values and names of the reasons, as the CF conventions have them."""
    own = {WORKER_DIED: "worker died", RAISED: "raised", UNKNOWN: "not run"}
    named = own | {code: re.split("[,:]", sentence)[0] for code, sentence in sorted(modes.REASONS.items())}
    words = [re.sub(r"\W+", "_", sentence).strip("_") for sentence in named.values()]
    return {"long_name": "why it ended", "flag_values": list(named), "flag_meanings": " ".join(words)}
