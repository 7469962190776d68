"""Calls of the engine that report progress and can be interrupted, whatever the engine is at."""

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
"""Work that the engine does before it lets the watch look for the first time, in evaluations of a contact: some
milliseconds.  Threads wait for each other at every look."""
_SECONDS = 5e-3
"""Time that it shall take later [s]: what follows may be dearer than what came before."""
_REPORTED_EVERY = 0.1
"""Time between two reports [s]."""


class Watch:
    """While entered, what is called through it reports now and then, and Ctrl-C ends it where nothing is lost.

    The engine calls the watch in the thread that waits for it, so that signals are served there.  Of what takes longer
    than a moment the first Ctrl-C is kept until the engine has come back; a second one goes to whatever runs in Python.
    A handler of the user's own for Ctrl-C stays in place: what it raises, or the report, ends the engine's call and is
    raised after it.

    Parameters
    ----------
    memory : Memory
        What the entry points are called on.
    """

    def __init__(self, memory: Memory) -> None:
        self._memory = memory
        self._report: Callable[[float], None] | None = None
        self._asked = False
        self._error: BaseException | None = None
        self._handles = False
        self._begin_to_look()

    def reporting(self, report: Callable[[float], None] | None) -> Watch:
        """Return it, after it was told what to call with the time reached [s]."""
        self._report = report
        return self

    def __enter__(self) -> Watch:
        interpreted.forget()
        if inspect.getgeneratorstate(self._looks) == inspect.GEN_CLOSED:
            # a second Ctrl-C has ended it
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
            After Ctrl-C; the state is that before what was unfinished.
        BaseException
            Whatever the report has raised.
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
        """Take Ctrl-C, where it is Python's own; to take it and to give it back takes longer than many a short run."""
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
        """Take the time reached [s]; return the work that may be done before the next look, nothing for a stop."""
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
        """Take what is to be raised when the engine has come back."""
        self._error = error


def _looks(of: weakref.ref[Watch]) -> Generator[float, float, None]:
    """Take the times at which a watch is to look, and give what it says.

    A generator, because a signal that has come while the engine ran is served where it goes on, inside of `try`;
    a function would be left before its first line.
    """
    answer = 0.0
    while True:
        try:
            t = yield answer
            watch = of()
            assert watch is not None
            answer = watch.look(t)
            # a cycle would keep it
            del watch
        except GeneratorExit:
            return
        except BaseException as error:
            answer, watch = 0.0, of()
            assert watch is not None
            watch.fail(error)
            del watch
