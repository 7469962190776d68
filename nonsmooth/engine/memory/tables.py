"""The tables of the memory: all arrays of all layers in order, the record of scalars, and the counts that size them.

Everything that the engine knows stands in one record ``S`` of scalars and two heaps.  An entry of ``S`` named after an
array holds the offset of that array in its heap.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.arrays import bodies, contact, delassus, events, flow, impact, numerics
from nonsmooth.engine.memory.arrays.arrays import Arrays, Size
from nonsmooth.engine.memory.scalars import FLOAT_SCALARS, INTEGER_SCALARS

# that of the events comes first: what no step reads of those before begins with its output
ARRAYS_OF: dict[str, Arrays] = {
    "events": events.ARRAYS,
    "bodies": bodies.ARRAYS,
    "numerics": numerics.ARRAYS,
    "delassus": delassus.ARRAYS,
    "contact": contact.ARRAYS,
    "impact": impact.ARRAYS,
    "flow": flow.ARRAYS,
}
"""The arrays by the layer of the engine that owns them."""
FLOAT_ARRAYS: dict[str, Size] = {
    **{name: size for arrays in ARRAYS_OF.values() for name, size in arrays.floats.items()},
    **{name: size for arrays in ARRAYS_OF.values() for name, size in arrays.later_floats.items()},
}
INTEGER_ARRAYS: dict[str, Size] = {
    **{name: size for arrays in ARRAYS_OF.values() for name, size in arrays.integers.items()},
    **{name: size for arrays in ARRAYS_OF.values() for name, size in arrays.later_integers.items()},
}
OWNER = {
    name: layer
    for layer, arrays in ARRAYS_OF.items()
    for table in (arrays.floats, arrays.integers, arrays.later_floats, arrays.later_integers)
    for name in table
}
"""The layer of the engine that an array belongs to."""

SCALARS = np.dtype(
    [(name, "i8") for name in INTEGER_SCALARS]
    + [(name, "f8") for name in FLOAT_SCALARS]
    + [(name, "i8") for name in (*FLOAT_ARRAYS, *INTEGER_ARRAYS)],
    align=True,
)
"""The record ``S``."""


def places(*names: str) -> NDArray[np.int64]:
    """Return where scalars stand in the record, all of which take as much room."""
    known = SCALARS.names or ()
    return np.array([known.index(name) for name in names])


COUNTS = (
    "n_bodies",
    "n_slots",
    "n_declared",
    "n_units",
    "n_partners",
    "n_paired",
    "n_pools",
    "n_own_guards",
    "n_loads",
    "n_joints",
    "n_articulations",
    "n_q",
    "n_u",
    "n_y",
    "n_states",
    "n_pivoted",
    "map_width",
    "event_floats",
    "event_integers",
    "sample_capacity",
)
"""The run-time sizes that :func:`allocate` takes."""
CONSTANT_SCALARS = frozenset((*COUNTS, *FLOAT_ARRAYS, *INTEGER_ARRAYS))
"""What never changes once the memory is laid out."""
