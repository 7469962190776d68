"""After a run: whether bodies passed into each other whose shapes the engine does not look at where its steps begin.

Those are shapes that do not consist of convex parts, such as meshes that are not convex.  Their solids are compared at
the samples of the run, of which those are left out before which nothing has moved by a hundredth of its size.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory import owners
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.overlaps import deepest_overlap
from nonsmooth.solution.state import Floats

_MOVED = 0.01
"""Part of a size by which something has moved before a sample is looked at: a smaller overlap stays in sight."""


def passed(model: LaidOut, rows: Floats) -> str:
    """Return what is said of the first sample at which bodies of a run overlap that must not, "" if there is none.

    Parameters
    ----------
    model : LaidOut
        What ran.
    rows : Floats
        Its samples, t and y first, shape [n, m].
    """
    contacts = model.system.contacts
    numbers = model.unwatched
    if not numbers:
        return ""
    left = Checkpoint.of(model.memory)
    size = min(contacts[i].size for i in numbers)
    try:
        for row in rows[_apart(rows[:, 1 : 1 + model.n_q], _MOVED * size)]:
            model.memory[owners.Island.time] = row[0]
            model.memory[owners.Island.y][: model.n_y] = row[1 : 1 + model.n_y]
            model.list_contacts()
            model.evaluate()
            found = deepest_overlap(model, numbers)
            if found is not None:
                contact, depth = found
                names = [model.system.name_of(body) for body in (contact.first, contact.second)]
                return (
                    f"bodies passed into each other. At t = {row[0]:.9g} s {names[0]!r} and {names[1]!r} of the "
                    f"{contact} overlap by at least {depth:.3g} m. Turn or shift one of them by a thousandth of its "
                    "size, or give its body convex pieces: MeshBody(..., decomposition=Decomposition())."
                )
    finally:
        left.put(model.memory)
        model.evaluate()
    return ""


def _apart(q: Floats, way: float) -> NDArray[np.int64]:
    """Return the numbers of samples, each of which has moved by a way from the one before it; the first and last."""
    chosen = [0]
    for i in range(1, len(q)):
        if np.max(np.abs(q[i] - q[chosen[-1]]), initial=0.0) > way:
            chosen.append(i)
    return np.array(sorted({*chosen, len(q) - 1}), np.int64)
