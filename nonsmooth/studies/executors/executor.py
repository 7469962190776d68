"""Executors: compute the chunks of a study in this thread, or in several."""

from __future__ import annotations

import os
import threading
from abc import ABC, abstractmethod
from collections.abc import Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from typing import final

from nonsmooth.errors import InvalidInput
from nonsmooth.studies.work import Chunk, ChunkResult, Work


class Executor(ABC):
    """Does chunks.

    The contract:

    1. ``blocks`` yields the block of each chunk once, in any order, as soon as it is done.
    2. A run is never split, and nothing of a run depends on where it is done: all executors give the same bits.
    3. Closing the iterator, and what is raised while it is waited for, ends all work.
    """

    @abstractmethod
    def blocks(self, work: Work, chunks: Sequence[Chunk]) -> Generator[ChunkResult, None, None]:
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


@final
@dataclass(frozen=True)
class Serial(Executor):
    """Does everything here."""

    def blocks(self, work: Work, chunks: Sequence[Chunk]) -> Generator[ChunkResult, None, None]:
        """Yield one after another."""
        for chunk in chunks:
            yield work.block(chunk)


_WINDOW = 2
"""Chunks per thread that are handed out at once."""


class _Ended(Exception):
    """The study is over for this thread."""


@final
@dataclass(frozen=True)
class Threads(Executor):
    """Does chunks in threads.

    Parameters
    ----------
    n : int, optional
        Number of threads; as many as there are processors by default.
    """

    n: int | None = None

    def __post_init__(self) -> None:
        check_workers("Threads: n", self.n)

    def blocks(self, work: Work, chunks: Sequence[Chunk]) -> Generator[ChunkResult, None, None]:
        """Yield as threads come to the end of chunks."""
        n, ended, left = check_workers("Threads: n", self.n), threading.Event(), iter(chunks)

        def before_each() -> None:
            if ended.is_set():
                raise _Ended

        pool = ThreadPoolExecutor(n)
        try:
            waiting: set[Future[ChunkResult]] = set()
            while True:
                for chunk in left:
                    waiting.add(pool.submit(work.block, chunk, before_each))
                    if len(waiting) >= _WINDOW * n:
                        break
                if not waiting:
                    return
                done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                for one in done:
                    yield one.result()
        finally:
            ended.set()
            pool.shutdown(cancel_futures=True)
