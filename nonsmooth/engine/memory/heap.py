"""The blocks behind the arrays of the field table, while a model is assembled."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from nonsmooth.engine.memory.blocks import GUARD, UNTOUCHED
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.parameters import SharedNumbers


class Heap:
    """The blocks behind the arrays of the table, while a model is assembled: output blocks, Jacobians, parameters.

    Their total length is known only at the end, so that they are collected here and copied by :meth:`close`.
    """

    def __init__(self, memory: Memory) -> None:
        """Begin to collect the blocks that :meth:`close` appends to the floats of ``memory``.

        :func:`allocate` made ``memory``, with all arrays whose size follows from counts.
        """
        self._memory = memory
        # offset of the first block among all floats
        self._first = memory.slots
        self._values = array("d")
        # ranges that change in a run: their offsets from the first block, and the length of each of them
        self._written: list[tuple[np.ndarray, int]] = []
        # numbers by which a function finds a table of shared parameters, such as those of a mesh: offset of the number
        # among all floats, the offset that is subtracted from that of the table, and the table; several at a time
        self._references: list[tuple[np.ndarray, np.ndarray, SharedNumbers]] = []

    def block(self, size: int) -> int:
        """Append ``size`` zeros, for numbers that the engine writes. Result: their offset among all floats."""
        start = self._first + len(self._values)
        # bytes of zeros are the float 0.0
        self._values.frombytes(bytes(self._values.itemsize * size))
        self.write(start, size)
        return start

    def write(self, starts: int | np.ndarray, size: int) -> None:
        """Mark ``size`` numbers from each of the offsets ``starts``: the engine or a plug-in writes them in a run."""
        # all other numbers of the blocks are parameters, the same in every run
        self._written.append((np.atleast_1d(starts) - self._first, size))

    def store(self, values: Sequence[float] | np.ndarray) -> int:
        """Append parameters. Result: their offset among all floats."""
        start = self._first + len(self._values)
        self._values.extend(values)
        return start

    def repeat(self, values: Sequence[float], times: int) -> int:
        """Append the same parameters ``times`` times. Result: the offset of the first among all floats."""
        start = self._first + len(self._values)
        self._values.extend(times * array("d", values))
        return start

    def refer(self, places: int | np.ndarray, starts: int | np.ndarray, table: SharedNumbers) -> None:
        """Let :meth:`close` set the numbers at ``places`` to the distances [floats] of a table from ``starts``."""
        # at a start begin the parameters of the function that reads the table. It gets only their address, so the table
        # must be found from there. Before close no table has an offset
        self._references.append((np.atleast_1d(places), np.atleast_1d(starts), table))

    def output(self, size: int) -> int:
        """Append ``size`` numbers that a plug-in writes, then guards, which show if it wrote too many.

        The result is their offset among all floats.
        """
        start = self.store(output_block(size))
        self.write(start, size)
        return start

    def close(self) -> Memory:
        """A new memory with the content of the old one, with the blocks, and with the tables behind all arrays.

        A table that many contacts refer to is there once. Views of the old memory do not show the new one.
        """
        old, tables = self._memory, {id(table): table for _, _, table in self._references}
        # offsets of the tables, from the first one on
        offsets = dict(zip(tables, np.cumsum([0, *map(len, tables.values())]).tolist(), strict=False))
        written = np.zeros(len(self._values), bool)
        for starts, size in self._written:
            written[starts[:, None] + np.arange(size)] = True
        references = [
            np.column_stack([places, starts, np.full(len(places), offsets[id(table)])])
            for places, starts, table in self._references
        ]
        made = replace(
            old,
            scalars=old.scalars.copy(),
            slots=self._first + len(self._values),
            references=np.concatenate([np.zeros((0, 3), int), *references]),
            written=written,
        )
        numbers = [np.zeros(0), *(np.asarray(table.numbers) for table in tables.values())]
        made.fill(old, old.counts, np.frombuffer(self._values), np.concatenate(numbers))
        return made


def output_block(size: int) -> list[float]:
    """Content of a block before a plug-in writes it: ``size`` zeros, then guards."""
    # a guard has a value that no plug-in writes by chance; if it changes, the plug-in wrote too many numbers
    return size * [0.0] + GUARD * [UNTOUCHED]
