"""Threads of this process: the engine runs without the lock of Python, building and summarising do not."""

from __future__ import annotations

import threading
from collections.abc import Generator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from typing import final

from nonsmooth.studies.executors.executor import Executor, check_workers
from nonsmooth.studies.work import Block, Chunk, Work

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

    def blocks(self, work: Work, chunks: Sequence[Chunk]) -> Generator[Block, None, None]:
        """Yield as threads come to the end of chunks."""
        n, ended, left = check_workers("Threads: n", self.n), threading.Event(), iter(chunks)

        def before_each() -> None:
            if ended.is_set():
                raise _Ended

        pool = ThreadPoolExecutor(n)
        try:
            waiting: set[Future[Block]] = set()
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
