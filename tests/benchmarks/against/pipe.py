"""The comparison's end of a worker: asks for a run, waits for the answer, starts another process if one is lost."""

from __future__ import annotations

import contextlib
import json
import os
import select
import subprocess
from types import TracebackType
from typing import Any

from tests.benchmarks.against.sides import Side

WORKER = "tests.benchmarks.against.worker"
FIRST = "first"
"""The argument of a worker that makes one run, that of the line on its standard input, and ends."""
_SILENT = 300.0
"""Wall time after which a process without an answer counts as hanging [s]: compiling, and the slowest run."""


class NoAnswer(RuntimeError):
    """A request that a worker could not answer, and why."""


class Worker:
    """A process of one side that answers requests; another one takes its place if it is lost."""

    def __init__(self, side: Side) -> None:
        self._side = side
        self.peak = 0.0
        """Largest memory of the processes that have ended [MB]."""
        self._start()

    def __enter__(self) -> Worker:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def ask(self, **request: Any) -> Any:
        """Return the answer to a request.

        Raises
        ------
        NoAnswer
            If the request failed, or the process ended or did not answer.
        """
        line, is_ready = b"", True
        with contextlib.suppress(BrokenPipeError):
            self._requests.write((json.dumps(request) + "\n").encode())
            self._requests.flush()
            is_ready = bool(select.select([self._answers], [], [], _SILENT)[0])
            line = self._answers.readline() if is_ready else b""
        if not line:
            self._process.kill()
            self.close()
            status = self._process.returncode
            self._start()
            why = f"the process ended with status {status}" if is_ready else f"no answer in {_SILENT:g} s"
            raise NoAnswer(f"{self._side.name} side: {why}")
        found = json.loads(line)
        if "error" in found:
            raise NoAnswer(f"{self._side.name} side: {found['error']}")
        return found["answer"]

    def close(self) -> None:
        """End the process, and note how much memory it had."""
        with contextlib.suppress(BrokenPipeError):
            self._requests.close()
        self._answers.close()
        _, status, used = os.wait4(self._process.pid, 0)
        self._process.returncode = os.waitstatus_to_exitcode(status)
        self.peak = max(self.peak, used.ru_maxrss / 1024.0)

    def _start(self) -> None:
        self._process = subprocess.Popen(
            self._side.command(WORKER),
            cwd=self._side.tree,
            env=self._side.environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        self._requests, self._answers = self._process.stdin, self._process.stdout
