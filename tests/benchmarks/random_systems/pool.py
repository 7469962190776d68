"""Worker processes with a time limit each: what does not come back is killed, and the rest goes on."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Callable, Iterable, Iterator
from multiprocessing.connection import Connection, wait
from typing import Any

Task = tuple[Any, ...]
LOADING = 60.0
"""Time that the first task of a process has in addition, as the engine is loaded in it [s]."""


def _serve(work: Callable[..., Any], pipe: Connection) -> None:
    # Ctrl-C is the parent's: it ends the workers
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    while True:
        task = pipe.recv()
        pipe.send(work(*task))


class _Worker:
    def __init__(self, work: Callable[..., Any]) -> None:
        context = multiprocessing.get_context("spawn")
        self.pipe, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(work, theirs), daemon=True)
        self.process.start()
        theirs.close()
        self.task: Task | None = None
        self.deadline, self.fresh = 0.0, True

    def begin(self, task: Task, seconds: float) -> None:
        self.task, self.deadline = task, time.monotonic() + seconds + (LOADING if self.fresh else 0.0)
        self.fresh = False
        self.pipe.send(task)

    def stop(self) -> None:
        self.process.kill()
        self.process.join()
        self.pipe.close()


def spread(
    work: Callable[..., Any], tasks: Iterable[Task], workers: int, seconds: float
) -> Iterator[tuple[Task, str, Any]]:
    """Yield each task with "back" and what ``work`` returned, or with "hang" or "crash" and None, as they end.

    Parameters
    ----------
    work : callable
        A function of a module, which the processes import.
    tasks : iterable of tuple
        Its arguments.
    workers : int
        Number of processes.
    seconds : float
        Wall time after which a process is killed [s].
    """
    waiting, pool = iter(tasks), [_Worker(work) for _ in range(workers)]
    try:
        for worker in pool:
            if (task := next(waiting, None)) is not None:
                worker.begin(task, seconds)
        while any(worker.task is not None for worker in pool):
            busy = [worker for worker in pool if worker.task is not None]
            rest = max(0.0, min(worker.deadline for worker in busy) - time.monotonic())
            ready = wait([worker.pipe for worker in busy], rest)
            for worker in busy:
                late = time.monotonic() > worker.deadline
                if worker.pipe not in ready and not late:
                    continue
                task, word, value = worker.task, "hang", None
                assert task is not None
                if worker.pipe in ready:
                    try:
                        word, value = "back", worker.pipe.recv()
                    except (EOFError, ConnectionError):
                        word = "crash"
                worker.task = None
                if word != "back":
                    worker.stop()
                    pool[pool.index(worker)] = worker = _Worker(work)
                yield task, word, value
                if (following := next(waiting, None)) is not None:
                    worker.begin(following, seconds)
    finally:
        for worker in pool:
            worker.stop()
