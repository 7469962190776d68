"""A child process that checks properties, and is ended if a component does not return.

A function that loops for ever cannot be stopped from Python, least of all when it is compiled. So all checks run in one
child process. Before each trial the child writes a report of the next call to a file and sets a watchdog
(:func:`faulthandler.dump_traceback_later`). The watchdog is a thread without Python. When its time is over, it appends
the traceback of the running code to the file and ends the process. The parent reads the file and starts another child
for the next component.

Components are sent by cloudpickle. If the child cannot import the module of a component by its name, it loads the
module from its file. Examples are a test file, and the file of ``nonsmooth check FILE.py:CLASS``.

A child takes some seconds to start, so one child checks all components in turn.
"""

from __future__ import annotations

import atexit
import contextlib
import faulthandler
import importlib.util
import io
import os
import pickle
import re
import signal
import subprocess
import sys
import sysconfig
import tempfile
import threading
import time
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any
from weakref import WeakKeyDictionary

from nonsmooth.engine.native.kernel import PLAIN
from nonsmooth.testing.outcome import Outcome, Subject, described, outcome_of

TRIAL = 600.0 if PLAIN else 60.0
"""Time that a trial may take [s]: trials by the engine take up to some seconds, and far longer in plain mode."""
CALL = 1.0
"""Time that a call of a component's function may take [s]: the engine calls it thousands of times a second."""
_SLACK = 0.1
"""Part of the time limit that must pass before the watchdog's deadline is postponed again. The deadline is not
postponed at each call, because this costs as much as a short trial."""


# The class and the functions below run in the parent process: they start a child process and ask it for outcomes.


class _Child:
    """A child process, with the file of its watchdog and the component that it holds."""

    def __init__(self) -> None:
        handle, name = tempfile.mkstemp(prefix="nonsmooth_check_")
        os.close(handle)
        self._report, self._subject = Path(name), _NOTHING
        code = "import sys; from nonsmooth.testing.child import serve; serve(sys.argv[1])"
        self._process = subprocess.Popen(
            [sys.executable, "-c", code, name], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )

    def ask(self, subject: Subject, name: str) -> Outcome:
        """Return the outcome of a property. Raise EOFError if the child process ends before it answers."""
        if subject is not self._subject:
            self._give(subject)
        return Outcome(*self._call("look", name))

    def _give(self, subject: Subject) -> None:
        import cloudpickle

        while True:
            missing = self._call("take", sys.path, _filters(), cloudpickle.dumps(subject))
            if not missing:
                self._subject = subject
                return
            module = sys.modules[missing]
            if module.__file__ is None:
                cloudpickle.register_pickle_by_value(module)
            else:
                self._call("load", missing, module.__file__)

    def _call(self, *request: Any) -> Any:
        stdin, stdout = self._process.stdin, self._process.stdout
        assert stdin is not None
        assert stdout is not None
        try:
            pickle.dump(request, stdin)
            stdin.flush()
            return pickle.load(stdout)
        except (BrokenPipeError, pickle.UnpicklingError) as error:
            raise EOFError from error

    def fault(self) -> tuple[str, Outcome]:
        """Return the property during whose check the child ended, and its outcome, which is "broken" with the reason.

        The property is "" if it is the one that the parent requested.
        """
        status = self._process.wait()
        with self._report.open("rb") as file:
            prop, words, seconds, parameter, value, case = pickle.load(file)
            trace = file.read().decode(errors="replace")
        if "Timeout" in trace:
            words = f"{words.replace('{takes}', f'takes longer than {seconds:g} s')}{_line(trace, words)}"
        else:
            words = f"the process that checks it ends with status {status}{_line(trace, words)}"
        return prop, Outcome("broken", words, parameter, value, case)

    def stop(self) -> None:
        """End the process."""
        for stream in (self._process.stdin, self._process.stdout):
            assert stream is not None
            with contextlib.suppress(BrokenPipeError):
                stream.close()
        self._process.kill()
        self._process.wait()
        self._report.unlink(missing_ok=True)


_NOTHING = Subject(None, lambda component: [], {}, object)
"""Placeholder for the component of a child that has just started."""
_children: list[_Child] = []
"""The child process: empty before the first check, then a list with one entry."""
_ended: WeakKeyDictionary[Subject, tuple[str, Outcome]] = WeakKeyDictionary()
"""Components whose check ended the child process, for example by an endless loop. The value is the name of the checked
property and its outcome. Other properties of such a component are not checked."""
_LOCK = threading.Lock()


@atexit.register
def stop_child() -> None:
    """End the child; the next property starts another one."""
    while _children:
        _children.pop().stop()


def ask(subject: Subject, name: str) -> Outcome:
    """Check a property of a component in a child process.

    A component that cannot be pickled is checked in this process, without a watchdog.
    """
    with _LOCK:
        if subject in _ended:
            return _judged(name, *_ended[subject])
        if not _children:
            _children.append(_Child())
        try:
            return _children[0].ask(subject, name)
        except EOFError:
            prop, fault = _children[0].fault()
            _ended[subject] = prop or name, fault
            stop_child()
            return _judged(name, *_ended[subject])
        except (pickle.PicklingError, TypeError, AttributeError, KeyError):
            return outcome_of(subject.all[name].check)
        except BaseException:
            stop_child()
            raise


def _judged(name: str, blamed: str, fault: Outcome) -> Outcome:
    if name == blamed:
        return fault
    return Outcome("not checked", f"not checked, as {blamed!r} does not hold: {fault.reason}")


def _filters() -> list[tuple[Any, ...]]:
    """Return the filters of warnings, the last one first, as arguments of :func:`warnings.filterwarnings`."""
    return [
        (action, _text(message), category, _text(module), line)
        for action, message, category, module, line in reversed(warnings.filters)
    ]


def _text(pattern: Any) -> str:
    return re.compile(pattern).pattern if pattern else ""


def _line(trace: str, words: str) -> str:
    """Return text that names the innermost line of a traceback in the author's own code; "" without a line.

    Code of this package, of Python and of installed packages is skipped. The text names the file, unless the message
    ``words`` does.
    """
    ours = [str(Path(__file__).parents[1]), *sysconfig.get_paths().values()]
    for file, line in re.findall(r'File "(.*)", line (\d+)', trace):
        if not any(file.startswith(folder) for folder in ours if folder):
            return f", at line {line}" if file in words else f", in {file} at line {line}"
    return ""


# functions and classes of the child process


class _Watchdog:
    """Ends the child process if a call takes too long. The parent then reads about the call in a report file."""

    def __init__(self, file: int) -> None:
        self._file, self._set_at, self._seconds = file, 0.0, 0.0

    def about_to(self, seconds: float, *report: Any) -> None:
        """Write the report of the next call. End the process unless another report follows within ``seconds``."""
        os.lseek(self._file, 0, os.SEEK_SET)
        os.write(self._file, pickle.dumps(report))
        os.ftruncate(self._file, os.lseek(self._file, 0, os.SEEK_CUR))
        now = time.monotonic()
        if seconds != self._seconds or now - self._set_at > _SLACK * seconds:
            self._set_at, self._seconds = now, seconds
            faulthandler.dump_traceback_later((1.0 + _SLACK) * seconds, exit=True, file=self._file)

    def rest(self) -> None:
        """Switch the watchdog off until the next report."""
        faulthandler.cancel_dump_traceback_later()
        self._seconds = 0.0


_watchdogs: list[_Watchdog] = []
"""The watchdog: a list with one entry in a child process, empty in the parent."""


def about_to(
    words: str, component: Any, case: Mapping[str, float] | None = None, *, seconds: float = TRIAL, prop: str = ""
) -> None:
    """Report the next call to the watchdog, which ends the process if the call takes too long.

    Outside of a child process there is no watchdog, and this function has no effect.

    Parameters
    ----------
    words : str
        The beginning of the message, such as "it {takes}", where "{takes}" stands for "takes longer than 60 s".
    component : object
        The component; its parameters are part of the report.
    case : mapping, optional
        The input of the call, its numbers by name.
    seconds : float, optional
        Time that the call may take [s].
    prop : str, optional
        Name of the property that fails if the call takes longer; by default the property that is being checked.
    """
    for watchdog in _watchdogs:
        watchdog.about_to(seconds, prop, words, seconds, *described(component), dict(case or {}))


def serve(report: str) -> None:
    """Check properties until standard input ends: the main function of the child."""
    # the parent handles Ctrl-C; output of a component goes to standard error, so that it does not mix with the answers
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    requests, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    file = os.open(report, os.O_RDWR)
    _watchdogs.append(_Watchdog(file))
    faulthandler.enable(file)
    _keep_constants()
    looks: dict[str, Any] = {}
    while True:
        try:
            kind, *words = pickle.load(requests)
        except EOFError:
            return
        answer: Any = ""
        if kind == "take":
            looks.clear()
            answer = _take(looks, *words)
        elif kind == "load":
            _load(*words)
        else:
            answer = tuple(_look(looks, *words))
        for watchdog in _watchdogs:
            watchdog.rest()
        pickle.dump(answer, answers)
        answers.flush()


def _take(looks: dict[str, Any], path: list[str], filters: list[tuple[Any, ...]], content: bytes) -> str:
    """Unpickle a component, and store it with its properties in ``looks`` as "component" and "rows".

    ``path`` is the module path of the parent, ``filters`` its filters of warnings. Returns the name of a module that is
    missing in the child, "" if none is missing.
    """
    sys.path[:] = path
    warnings.resetwarnings()
    for words in filters:
        warnings.filterwarnings(*words)
    try:
        subject: Subject = pickle.loads(content)
    except ModuleNotFoundError as error:
        return str(error.name)
    looks["component"], looks["rows"] = subject.component, subject.all
    return ""


def _load(name: str, path: str) -> None:
    """Load a module from its file."""
    specification = importlib.util.spec_from_file_location(name, path)
    assert specification is not None
    assert specification.loader is not None
    # dataclasses and numba find modules by name
    module = sys.modules[name] = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)


def _look(looks: dict[str, Any], name: str) -> Outcome:
    about_to("it {takes}", looks["component"])
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        found = outcome_of(looks["rows"][name].check)
    return found._replace(printed=printed.getvalue())


def _keep_constants() -> None:
    """Make hypothesis store the constants that it collects in the user's cache, not in the working folder."""
    from nonsmooth.user_cache import user_cache

    cache = user_cache()
    folder = Path(tempfile.gettempdir()) if cache is None else cache
    os.environ.setdefault("HYPOTHESIS_STORAGE_DIRECTORY", str(folder / "nonsmooth" / "hypothesis"))
