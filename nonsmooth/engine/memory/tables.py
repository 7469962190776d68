"""The tables of the memory: all arrays of all layers in order, the record of scalars, and the counts that size them.

Everything that the engine knows stands in one record ``S`` of scalars and two heaps.  An entry of ``S`` named after an
array holds the offset of that array in its heap.  What an engine of one's own brings stands behind all that.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from nonsmooth.engine.memory.arrays import bodies, contact, delassus, events, flow, impact, numerics, pairs
from nonsmooth.engine.memory.arrays.arrays import Arrays, Size

# that of the events comes first: what no step reads of those before begins with its output
ARRAYS_OF: dict[str, Arrays] = {
    "events": events.ARRAYS,
    "bodies": bodies.ARRAYS,
    "pairs": pairs.ARRAYS,
    "numerics": numerics.ARRAYS,
    "delassus": delassus.ARRAYS,
    "contact": contact.ARRAYS,
    "impact": impact.ARRAYS,
    "flow": flow.ARRAYS,
}
"""The scalars and arrays by the layer of the engine that owns them: the lowest that uses them."""


def floats_of(layers: Iterable[Arrays]) -> dict[str, Size]:
    """Return the arrays of floats of some layers in the order in which they stand: those that come later last."""
    return _in_order((arrays.floats, arrays.later_floats) for arrays in layers)


def integers_of(layers: Iterable[Arrays]) -> dict[str, Size]:
    """Return the arrays of integers of some layers likewise."""
    return _in_order((arrays.integers, arrays.later_integers) for arrays in layers)


def _in_order(tables: Iterable[tuple[dict[str, Size], dict[str, Size]]]) -> dict[str, Size]:
    early, later = zip(*tables, strict=True)
    return {name: size for table in (*early, *later) for name, size in table.items()}


def _fields(*layers: Arrays) -> list[tuple[str, str]]:
    scalars = {name: begin for arrays in layers for name, begin in arrays.scalars.items()}
    numbers = [(name, "f8" if isinstance(begin, float) else "i8") for name, begin in scalars.items()]
    return numbers + [(name, "i8") for name in (*floats_of(layers), *integers_of(layers))]


FLOAT_ARRAYS = floats_of(ARRAYS_OF.values())
INTEGER_ARRAYS = integers_of(ARRAYS_OF.values())
SCALARS = np.dtype(_fields(*ARRAYS_OF.values()), align=True)
"""The record ``S``."""
N_SCALARS = len(SCALARS.names or ())
"""How many fields it has."""


def record_with(own: Arrays) -> np.dtype[np.void]:
    """Return the record ``S`` of an engine that has scalars and arrays of its own, which stand at its end."""
    fields = _fields(own)
    return np.dtype([*SCALARS.descr, *fields], align=True) if fields else SCALARS


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
    "n_walls",
    "n_pools",
    "n_pairs",
    "n_carriers",
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
