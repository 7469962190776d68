"""Calls of the engine that report progress and can be interrupted, whatever the engine is at."""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Callable, Generator
from types import FrameType, TracebackType
from typing import Any

from nonsmooth.binding import interpreted
from nonsmooth.engine.memory.memory import Memory
from nonsmooth.engine.native.kernel import call_entry, forget_watch, watch_address

_FIRST = 256
"""Work that the engine does before it lets the watch look for the first time, in evaluations of a contact,"""
_SECONDS = 5e-3
"""and the time that it shall take later [s]: what follows may be dearer than what came before."""
_REPORTED_EVERY = 0.1
"""Time between two reports [s]."""


class Watch:
    """While entered, what is called through it reports now and then, and Ctrl-C ends it where nothing is lost.

    The engine calls the watch in the thread that waits for it, so that signals are served there.  The first Ctrl-C is
    kept until the engine has come back; a second one goes to whatever runs in Python.  A handler of the user's own for
    Ctrl-C stays in place: what it raises, or the report, ends the engine's call and is raised after it.

    Parameters
    ----------
    memory : Memory
        What the entry points are called on.
    report : callable, optional
        Called with the time reached [s].
    """

    def __init__(self, memory: Memory, report: Callable[[float], None] | None = None) -> None:
        self._memory, self._report = memory, report
        self._asked = False
        self._error: BaseException | None = None
        self._handles = False

    def __enter__(self) -> Watch:
        interpreted.forget()
        self._looks = self._look()
        self._patience = next(self._looks)
        self._address = watch_address(self._looks.send)
        self._last = self._reported = time.perf_counter()
        scalars = self._memory.scalars
        scalars["watch"], scalars["patience"] = self._address, _FIRST
        self._handles = (
            threading.current_thread() is threading.main_thread()
            and signal.getsignal(signal.SIGINT) is signal.default_int_handler
        )
        if self._handles:
            signal.signal(signal.SIGINT, self._ask)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._handles:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        self._memory.scalars["watch"] = 0
        forget_watch(self._address)
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

    def _ask(self, number: int, frame: FrameType | None) -> None:
        if self._asked:
            raise KeyboardInterrupt
        self._asked = True

    def _look(self) -> Generator[float, float, None]:
        """Take the time reached; give the work that may be done before the next look, nothing for a stop.

        A generator, because a signal that has come while the engine ran is served where it goes on, inside of `try`;
        a function would be left before its first line.
        """
        patience = float(_FIRST)
        while True:
            try:
                t = yield 0.0 if self._asked or self._error is not None else patience
                now = time.perf_counter()
                share = _SECONDS / max(now - self._last, 1e-2 * _SECONDS)
                patience = max(1.0, patience * min(4.0, share))
                self._last = now
                if self._report is not None and now - self._reported >= _REPORTED_EVERY:
                    self._reported = now
                    self._report(t)
            except GeneratorExit:
                return
            except BaseException as error:
                self._error = error
