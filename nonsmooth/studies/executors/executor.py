"""Executor: does the chunks of a study, in any order, each whole."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Generator, Sequence

from nonsmooth.errors import InvalidInput
from nonsmooth.studies.work import Block, Chunk, Work


class Executor(ABC):
    """Does chunks.

    The contract:

    1. ``blocks`` yields the block of each chunk once, in any order, as soon as it is done.
    2. A run is never split, and nothing of a run depends on where it is done: all executors give the same bits.
    3. Closing the iterator, and what is raised while it is waited for, ends all work.
    """

    @abstractmethod
    def blocks(self, work: Work, chunks: Sequence[Chunk]) -> Generator[Block, None, None]:
        """Yield what comes of the chunks.

        Raises
        ------
        InvalidInput
            If nobody answers who could do it.
        """


def check_workers(thing: str, n: int | None) -> int:
    """Return a number of workers, one for each processor by default.

    Raises
    ------
    InvalidInput
        If it is no positive whole number.
    """
    if n is None:
        return os.cpu_count() or 1
    if not isinstance(n, int) or n < 1:
        raise InvalidInput(thing, "must be a positive whole number", n, "Leave it out for one for each processor.")
    return n
