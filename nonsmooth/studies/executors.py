"""Executors: compute the chunks of a study in this thread, or in several."""

from __future__ import annotations

import os
import threading
from abc import ABC, abstractmethod
from collections.abc import Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from typing import final

from nonsmooth.checks import check_count
from nonsmooth.studies.work import Chunk, ChunkResult, Work

WINDOW = 2
"""Number of chunks per worker that are submitted at a time, so that each worker has its next chunk at once."""


class Executor(ABC):
    """Computes the chunks of a study.

    The contract:

    1. ``results`` yields the result of each chunk once, in any order, as soon as it is complete.
    2. A run is never split, and does not depend on where it is computed: all executors give the same bits.
    3. Closing the iterator, or an exception while it waits, ends all work.
    """

    @abstractmethod
    def results(self, work: Work, chunks: Sequence[Chunk]) -> Generator[ChunkResult, None, None]:
        """Yield the results of chunks.

        Raises
        ------
        InvalidInput
            If no worker answers.
        """


def check_workers(thing: str, n: int | None) -> int:
    """Return a number of workers, by default one for each processor.

    Raises
    ------
    InvalidInput
        If the number is not a positive integer.
    """
    if n is None:
        return os.cpu_count() or 1
    check_count(thing, n, "must be a positive whole number", "Leave it out for one for each processor.")
    return n


@final
@dataclass(frozen=True)
class Serial(Executor):
    """Computes one run after another in this thread."""

    def results(self, work: Work, chunks: Sequence[Chunk]) -> Generator[ChunkResult, None, None]:
        """Yield one result after another."""
        yield from map(work.chunk, chunks)


class _Ended(Exception):
    """The study has ended; the thread stops before its next run."""


@final
@dataclass(frozen=True)
class Threads(Executor):
    """Computes chunks in threads of this process.

    The engine releases the global lock of Python, so that runs are computed in parallel.  Building and summarising runs
    hold the lock.

    Parameters
    ----------
    n : int, optional
        Number of threads; one for each processor by default.
    """

    n: int | None = None

    def __post_init__(self) -> None:
        check_workers("Threads: n", self.n)

    def results(self, work: Work, chunks: Sequence[Chunk]) -> Generator[ChunkResult, None, None]:
        """Yield results as threads complete them."""
        n, ended, left = check_workers("Threads: n", self.n), threading.Event(), iter(chunks)

        def before_each() -> None:
            if ended.is_set():
                raise _Ended

        pool = ThreadPoolExecutor(n)
        try:
            waiting: set[Future[ChunkResult]] = set()
            while True:
                for chunk in left:
                    waiting.add(pool.submit(work.chunk, chunk, before_each))
                    if len(waiting) >= WINDOW * n:
                        break
                if not waiting:
                    return
                done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                for one in done:
                    yield one.result()
        finally:
            ended.set()
            pool.shutdown(cancel_futures=True)
