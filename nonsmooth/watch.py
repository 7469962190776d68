"""Calls of the engine that report progress and can be interrupted at any time."""

from __future__ import annotations

import inspect
import signal
import threading
import time
import weakref
from collections.abc import Callable, Generator
from types import FrameType, TracebackType
from typing import Any

from nonsmooth.binding import interpreted
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.native.kernel import call_entry, forget_watch, watch_address

_FIRST = 8192
"""Work done before the first interrupt check [evaluations of a contact]; this work takes some milliseconds.

Shorter calls have no check, because threads wait for each other at a check.
"""
_SECONDS = 5e-3
"""Time between two interrupt checks, after the first one [s].

Each check sets the work until the next check anew, because the work may take longer than before.
"""
_REPORTED_EVERY = 0.1
"""Time between two reports [s]."""


class Watch:
    """Context in which calls of the engine report progress, and Ctrl-C ends them without loss of results.

    The engine calls the interrupt check in the thread that called the engine, where Python handles signals. In a call
    that takes longer than some milliseconds the first Ctrl-C is kept until the engine returns. A second one interrupts
    the Python code that runs. A handler of the user for Ctrl-C stays in place. An exception of this handler, or of the
    function that reports progress, ends the call of the engine, and is raised after it.

    Parameters
    ----------
    memory : Memory
        The memory on which entry points are called.
    """

    def __init__(self, memory: Memory) -> None:
        self._memory = memory
        self._report: Callable[[float], None] | None = None
        self._asked = False
        self._error: BaseException | None = None
        self._handles = False
        self._begin_to_look()

    def reporting(self, report: Callable[[float], None] | None) -> Watch:
        """Set the function that gets the time reached [s], or None for no reports. The result is the watch."""
        self._report = report
        return self

    def __enter__(self) -> Watch:
        interpreted.forget()
        if inspect.getgeneratorstate(self._looks) == inspect.GEN_CLOSED:
            # a second Ctrl-C has ended the generator that checks for interrupts: make a new one
            self._begin_to_look()
        self._began = self._last = self._reported = time.perf_counter()
        self._patience, self._settled = float(_FIRST), False
        self._memory[owners.Request.interrupt_check], self._memory[owners.Request.work_budget] = self._address, _FIRST
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._handles:
            signal.signal(signal.SIGINT, signal.default_int_handler)
            self._handles = False
        self._memory[owners.Request.interrupt_check], self._report = 0, None
        if error is None:
            self._stop_if_asked()

    def call(self, name: str, *arguments: float) -> Any:
        """Call an entry point.

        Raises
        ------
        KeyboardInterrupt
            After Ctrl-C. The memory has the last state that the engine completed.
        BaseException
            An exception of the function that reports progress.
        """
        self._stop_if_asked()
        self._last = self._reported = time.perf_counter()
        result = call_entry(name, self._memory, *arguments)
        self._stop_if_asked()
        return result

    def _stop_if_asked(self) -> None:
        if interpreted.let_go():
            self._asked = True
        error, asked = self._error, self._asked
        self._error, self._asked = None, False
        if error is not None:
            raise error
        if asked:
            raise KeyboardInterrupt

    def _begin_to_look(self) -> None:
        self._looks = _looks(weakref.ref(self))
        next(self._looks)
        self._address = watch_address(self._looks.send)
        weakref.finalize(self, forget_watch, self._address)

    def _handle(self) -> None:
        """Set a handler for Ctrl-C if the user has set none. It takes time, so only long calls do it."""
        self._handles = (
            threading.current_thread() is threading.main_thread()
            and signal.getsignal(signal.SIGINT) is signal.default_int_handler
        )
        if self._handles:
            signal.signal(signal.SIGINT, self._ask)

    def _ask(self, number: int, frame: FrameType | None) -> None:
        if self._asked:
            raise KeyboardInterrupt
        self._asked = True

    def look(self, t: float) -> float:
        """Interrupt check at the time reached [s]. Result: work budget until the next check, 0 to stop the run."""
        now = time.perf_counter()
        share = _SECONDS / max(now - self._last, 1e-2 * _SECONDS)
        self._patience = max(1.0, self._patience * min(4.0, share))
        self._last = now
        if not self._settled and now - self._began > _SECONDS:
            self._settled = True
            self._handle()
        if self._report is not None and now - self._reported >= _REPORTED_EVERY:
            self._reported = now
            self._report(t)
        return 0.0 if self._asked else self._patience

    def fail(self, error: BaseException) -> None:
        """Store an exception of the interrupt check; it is raised after the engine has returned."""
        self._error = error


def _looks(of: weakref.ref[Watch]) -> Generator[float, float, None]:
    """Interrupt check as a generator: it receives the time of the run at each check [s], and yields the work budget.

    During a call of the engine, Ctrl-C stays pending. Python raises its exception when the engine calls the check, at
    the first instruction of Python code there. In a generator this instruction lies inside ``try``. In a function it
    would lie before ``try``, so the exception would not be caught.
    """
    answer = 0.0
    while True:
        try:
            t = yield answer
            watch = of()
            assert watch is not None
            answer = watch.look(t)
            # drop the reference: while the generator waits, it would prevent Python from freeing an unused watch
            del watch
        except GeneratorExit:
            return
        except BaseException as error:
            answer, watch = 0.0, of()
            assert watch is not None
            watch.fail(error)
            del watch
