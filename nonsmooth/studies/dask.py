"""Executor that computes a study by workers of dask: processes of this machine, or of a scheduler elsewhere."""

from __future__ import annotations

import contextlib
import hashlib
import itertools
import logging
import pickle
from collections.abc import Generator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, final

from nonsmooth.errors import InvalidInput, NonsmoothError
from nonsmooth.plugins import file
from nonsmooth.results.output import versions
from nonsmooth.studies.executors import WINDOW, Executor, check_workers
from nonsmooth.studies.inputs import require
from nonsmooth.studies.work import Chunk, ChunkResult, Work

if TYPE_CHECKING:
    from distributed import Client, LocalCluster


_PATIENCE = 5.0
"""Time within which a scheduler of dask must answer [s]; its first worker may take twelve times as long."""
_DEATHS = 3
"""Number of workers that die while they compute a chunk, before its runs are repeated one by one.

A single death may have another cause, for example a run of another chunk of the same worker.
"""


class SchedulerLost(NonsmoothError):
    """The scheduler ended, or could no longer be reached, before the end of the study."""


@final
@dataclass(frozen=True)
class Dask(Executor):
    """Computes chunks by workers of dask.

    Parameters
    ----------
    scheduler : str, optional
        Address of a scheduler of dask, such as "tcp://10.0.0.1:8786"; processes of this machine by default.
    n : int, optional
        Number of processes; one for each processor by default.
    """

    scheduler: str | None = None
    n: int | None = None

    def __post_init__(self) -> None:
        check_workers("Dask: n", self.n)

    def results(self, work: Work, chunks: Sequence[Chunk]) -> Generator[ChunkResult, None, None]:
        """Yield results as workers return them.

        A chunk may lose its worker through another chunk that killed the worker.  Chunks whose workers died too often
        are therefore repeated last, one run at a time.  This identifies the run that kills a worker.

        Raises
        ------
        InvalidInput
            If no scheduler answers, or workers have other versions, or do not find the classes of the study.
        SchedulerLost
            If the scheduler ends, or can no longer be reached, before the end of the study.
        """
        require("the executor dask", "dask", "distributed")
        from distributed import CancelledError

        with contextlib.ExitStack() as stack:
            client, parcel = self._client(stack), Parcel.of(work)
            _check_workers(client, parcel)
            suspects: list[Chunk] = []
            window = WINDOW * max(1, sum(client.nthreads().values()))
            try:
                yield from _in_turn(client, parcel, chunks, window, suspects)
                for chunk in suspects:
                    yield _run_by_run(client, parcel, chunk)
            except CancelledError as error:
                raise SchedulerLost(
                    "The scheduler is gone. Complete chunks stay: start a scheduler, and run the study again."
                ) from error

    def _client(self, stack: contextlib.ExitStack) -> Client:
        import dask
        from distributed import Client

        settings = {
            "distributed.scheduler.allowed-failures": _DEATHS - 1,
            # by default a worker keeps a profile of its stacks for an hour, 100 MB after some minutes
            "distributed.worker.profile.enabled": False,
        }
        stack.enter_context(dask.config.set(settings))
        address: Any = self.scheduler
        if address is None:
            n = check_workers("Dask: n", self.n)
            address = stack.enter_context(_cluster(n))
            # adapt starts a new worker for a dead one. The nanny, dask's process that restarts a worker, does not
            # suffice: it ends together with a worker that dies immediately
            address.adapt(minimum=n, maximum=n)
        try:
            return stack.enter_context(Client(address, timeout=_PATIENCE))
        except (OSError, ValueError) as error:
            remedy = "Start one by `dask scheduler`, with workers by `dask worker ADDRESS`, or leave the address out."
            raise InvalidInput("scheduler", f"must answer within {_PATIENCE:g} s", self.scheduler, remedy) from error


def _cluster(n: int) -> LocalCluster:
    """Start ``n`` worker processes on this machine.

    Raises
    ------
    InvalidInput
        If the processes cannot start.
    """
    from distributed import LocalCluster

    quiet = logging.CRITICAL
    try:
        return LocalCluster(n_workers=n, threads_per_worker=1, dashboard_address=":0", silence_logs=quiet)
    except RuntimeError as error:
        remedy = 'Put what a script does under `if __name__ == "__main__":`, as each process reads it; or take threads.'
        raise InvalidInput("executor dask", "must be able to start processes", str(error), remedy) from error


def _check_workers(client: Client, parcel: Parcel) -> None:
    """Raise InvalidInput if a worker lacks modules of the study, or has other versions of software or another machine.

    Other versions of nonsmooth, Python or numpy, and other machines, may change the last bits of the results.
    """
    client.wait_for_workers(1, timeout=_PATIENCE * 12)
    here = dict(versions())
    for address, there in client.run(versions).items():
        if dict(there) != here:
            differ = {name: there.get(name) for name in here if there.get(name) != here[name]}
            remedy = "Install the same ones; of unlike processors set NUMBA_CPU_NAME=generic everywhere."
            raise InvalidInput(f"worker {address}", f"must have the versions of this process, {here}", differ, remedy)
    for address, fault in client.run(Parcel.fault, parcel).items():
        if fault:
            remedy = "Install it there, or start the workers where they find it (PYTHONPATH)."
            raise InvalidInput(f"worker {address}", "must find what the study runs", fault, remedy)


def _computed(parcel: Parcel, chunk: Chunk) -> ChunkResult:
    return parcel.open().chunk(chunk)


def _in_turn(
    client: Client, parcel: Parcel, chunks: Sequence[Chunk], window: int, suspects: list[Chunk]
) -> Generator[ChunkResult, None, None]:
    """Yield the results of chunks, of which at most ``window`` are submitted at a time.

    A chunk that has lost :data:`_DEATHS` workers gives no result, and is added to ``suspects``.
    """
    from distributed import KilledWorker, as_completed

    left, running, done = iter(chunks), {}, as_completed()

    def hand_out(n: int) -> None:
        for chunk in itertools.islice(left, n):
            future = client.submit(_computed, parcel, chunk, pure=False, retries=2)
            running[future.key] = chunk
            done.add(future)

    hand_out(window)
    for future in done:
        chunk = running.pop(future.key)
        hand_out(1)
        try:
            block = future.result()
        except KilledWorker:
            suspects.append(chunk)
        else:
            yield block


def _run_by_run(client: Client, parcel: Parcel, chunk: Chunk) -> ChunkResult:
    """Return the result of a suspected chunk, computed one run at a time, which shows the run that kills a worker."""
    from distributed import KilledWorker

    def result(run: Chunk) -> ChunkResult:
        try:
            return client.submit(_computed, parcel, run, pure=False).result()  # type: ignore[no-any-return]
        except KilledWorker:
            text = "The process that ran it died, in each of the tries that the scheduler allows."
            return parcel.open().crashed(run, text)

    return ChunkResult.joined([result(run) for run in chunk.runs()])


@final
@dataclass(frozen=True)
class Parcel:
    """Pickled work for another process, with the files of user classes that it needs.

    The task opens the parcel, so that a failure is an error of the task.  If dask unpickled the work, a failure would
    end the connection.

    Attributes
    ----------
    content : bytes
        The work, pickled.
    files : tuple of tuple of str
        Path and sha256 of each file with a class that was named as FILE.py:CLASS.
    """

    content: bytes
    files: tuple[tuple[str, str], ...]

    @classmethod
    def of(cls, work: Work) -> Parcel:
        """Pickle work, and list the files of user classes that this process has loaded."""
        import cloudpickle

        return cls(cloudpickle.dumps(work), tuple((str(path), _digest(path)) for path in file.loaded()))

    def open(self) -> Work:
        """Load the files, and return the unpickled work.

        Raises
        ------
        InvalidInput
            If a file is missing or has another content.
        ImportError
            If a module is not installed.
        """
        for name, digest in self.files:
            path = Path(name)
            if not path.is_file() or _digest(path) != digest:
                remedy = "Start workers where they see the same files."
                raise InvalidInput("worker", "must find the file that the study was begun with", name, remedy)
            file.again(path)
        work: Work = pickle.loads(self.content)
        return work

    def fault(self) -> str:
        """Return the text of the error that :meth:`open` raises in this process, "" if the work can be unpickled."""
        try:
            self.open()
        except Exception as error:  # a module of a user may raise anything
            return f"{type(error).__name__}: {error}"
        return ""


def _digest(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()
