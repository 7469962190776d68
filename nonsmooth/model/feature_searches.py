"""FeatureSearch: a search for candidate features of two shapes, which share a number of contacts.

Two surfaces may have millions of pairs of features, of which a few are near each other. A search finds these and
assigns them to the contacts of the two shapes.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from nonsmooth.binding import interpreted
from nonsmooth.binding.bounds import try_out
from nonsmooth.binding.compile import bind, parameter_place
from nonsmooth.binding.source import described
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.blocks import CANDIDATE
from nonsmooth.engine.memory.heap import Heap
from nonsmooth.engine.memory.layout import NO_PAIR
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces import CandidateSearch, FeaturePair
from nonsmooth.model.laying import write_record
from nonsmooth.model.row_table import RowTable
from nonsmooth.parameters import SharedNumbers
from nonsmooth.system.contacts import Contacts


@dataclass(frozen=True)
class FeatureSearch:
    """A search for candidate features of two frames, and the contacts that it fills.

    Attributes
    ----------
    candidates : CandidateSearch
        The function of the search and its parameters.
    row : int
        Number of the row of the contacts.
    contacts : range
        Numbers of the contacts.
    owner : str
        Name of the first contact, for messages.
    """

    candidates: CandidateSearch
    row: int
    contacts: range
    owner: str

    @property
    def size(self) -> int:
        """Largest number of floats that the search may write: the number of pairs that it found, then the pairs."""
        # one pair more than there are contacts shows that these are too few
        return 1 + CANDIDATE * (len(self.contacts) + 1)


def find_searches(contacts: Contacts) -> list[FeatureSearch]:
    """The searches for candidate features, in the order of their contacts: one for each row with the same object.

    Raises
    ------
    InvalidInput
        If a shape is unbounded. Its displacement has no bound, so no time for the next search is known.
    """
    found: list[FeatureSearch] = []
    # rows share their kinematics: searches of each, and the indices of their contacts in the row
    known: dict[int, list[tuple[CandidateSearch, range]]] = {}
    for place, (row, start) in enumerate(zip(contacts.rows, contacts.starts.tolist(), strict=False)):
        if id(row.kinematics) not in known:
            known[id(row.kinematics)] = _searches_of(row.kinematics)
        for search, own in known[id(row.kinematics)]:
            contact = row.contact(own.start)
            for shape, extent in zip(row.shapes, row.extents, strict=True):
                if not math.isfinite(extent):
                    raise InvalidInput(
                        f"{type(shape).__name__} of the {contact}",
                        "must be bounded if its features are searched for (`candidates`)",
                        extent,
                        "Give the shape a finite `extent`, or return contacts of given features from `between`.",
                    )
            numbers = range(start + own.start, start + own.stop)
            found.append(FeatureSearch(search, place, numbers, str(contact)))
    return found


def _searches_of(kinematics: Sequence[FeaturePair]) -> list[tuple[CandidateSearch, range]]:
    """The searches of the contacts of two shapes, and the indices of the contacts of each, which are consecutive."""
    found: list[tuple[CandidateSearch, range]] = []
    for search, group in itertools.groupby(enumerate(kinematics), lambda item: item[1].candidates):
        indices = [index for index, _ in group]
        if search is not None:
            found.append((search, range(indices[0], indices[-1] + 1)))
    return found


def lay_searches(
    memory: Memory,
    blocks: Heap,
    searches: Sequence[FeatureSearch],
    table: RowTable,
    spheres: Mapping[tuple[int, int], int],
) -> None:
    """Write the searches. ``spheres`` has the bounding sphere of each frame, by the numbers of body and frame.

    The pairs that a search finds are valid until the features have moved too far. Of convex shapes this is known of
    their pair. Other features may lie anywhere in their spheres, so their distance from the origin, ``feature_radius``,
    is taken as the radius of the sphere.
    """
    # rows with the same kinematics share function and parameters
    known: dict[int, dict[str, int]] = {}
    for number, search in enumerate(searches):
        key = id(search.candidates)
        if key not in known:
            known[key] = _lay_function(blocks, search)
        fields = {**known[key], "out": blocks.output(search.size)}
        # body and frame of both sides
        sides = zip(table.bodies[search.row].tolist(), table.frames[search.row].tolist(), strict=True)
        sphere_a, sphere_b = (spheres[side] for side in sides)
        fields |= {"row": search.row, "first_contact": search.contacts.start, "n_contacts": len(search.contacts)}
        fields |= {"sphere_a": sphere_a, "sphere_b": sphere_b}
        write_record(memory, owners.Search, number, fields)
        pair = int(memory[owners.RowRecord.pair][search.row])
        if pair != NO_PAIR and memory[owners.Pair.is_guarded][pair]:
            continue
        for sphere in (sphere_a, sphere_b):
            memory[owners.BoundingSphere.feature_radius][sphere] = memory[owners.BoundingSphere.radius][sphere]


def _lay_function(blocks: Heap, search: FeatureSearch) -> dict[str, int]:
    """Compile and try out the function of a search, and store its parameters among the blocks.

    The result has fields of a record: address of the function, and offset of the parameters. Tables of
    meshes may be large, so the parameters get a reference to a table, which several searches share.
    """
    function, values = search.candidates.function, search.candidates.values
    tables = {name: value for name, value in values.items() if isinstance(value, SharedNumbers)}
    # with an empty tuple in place of each table
    address, numbers = bind(function, "pair", {**values, **dict.fromkeys(tables, ())}, search.owner)
    # the trial reads the tables behind the other parameters; the engine reads them at their distance from those
    all_numbers = bind(function, "pair", values, search.owner)[1] if tables else numbers
    try_out(function, "pair", values, all_numbers, search.size, search.owner)
    start = blocks.store(numbers)
    for name, table in tables.items():
        blocks.refer(start + parameter_place(function, "pair", name), start, table)
    return {"function": address, "parameters": start}


def failed_search(memory: Memory, contacts: Contacts) -> str:
    """Sentence that names the first search whose number of features is negative or not a number, or "".

    For the message of a run that a search has failed. An exception in the function gives NaN.
    """
    for number, search in enumerate(find_searches(contacts)):
        # the first number of its output
        found = memory.floats[int(memory[owners.Search.out][number])]
        if not found >= 0.0:
            function = search.candidates.function
            fault = interpreted.noted(function) or f"raises or gives {found:g}"
            return f"{search.owner}: {described(function)}, {fault} as the number of features that it found."
    return ""
