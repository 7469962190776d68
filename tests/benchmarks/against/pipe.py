"""The comparison's end of a worker: asks for a run, waits for the answer, starts another process if one is lost."""

from __future__ import annotations

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


class Worker:
    """A process of one side that runs what it is asked to run."""

    def __init__(self, side: Side) -> None:
        self._side = side
        self._process = self._started()
        self.peak = 0.0
        """Largest memory of the processes that have ended [MB]."""

    def __enter__(self) -> Worker:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def ask(self, **request: Any) -> dict[str, Any]:
        """Return the answer, under the key ``answer``, or why there is none, under ``error``."""
        request_line = json.dumps(request) + "\n"
        try:
            self._process.stdin.write(request_line.encode())  # type: ignore[union-attr]
            self._process.stdin.flush()  # type: ignore[union-attr]
        except BrokenPipeError:
            return self._lost()
        ready, _, _ = select.select([self._process.stdout], [], [], _SILENT)
        if not ready:
            self._process.kill()
            self._again()
            return {"error": f"no answer in {_SILENT:g} s"}
        line = self._process.stdout.readline()  # type: ignore[union-attr]
        if not line:
            return self._lost()
        found: dict[str, Any] = json.loads(line)
        return found

    def close(self) -> None:
        """End the process, and note how much memory it had."""
        self._process.stdin.close()  # type: ignore[union-attr]
        self._process.stdout.close()  # type: ignore[union-attr]
        _, status, used = os.wait4(self._process.pid, 0)
        self._process.returncode = os.waitstatus_to_exitcode(status)
        self.peak = max(self.peak, used.ru_maxrss / 1024.0)

    def _lost(self) -> dict[str, Any]:
        self._again()
        return {"error": f"the process ended with status {self._process.returncode}"}

    def _again(self) -> None:
        self.close()
        self._process = self._started()

    def _started(self) -> subprocess.Popen[bytes]:
        return subprocess.Popen(
            self._side.command(WORKER),
            cwd=self._side.tree,
            env=self._side.environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
        )
