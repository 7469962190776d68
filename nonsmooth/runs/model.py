"""Model: a system that is laid out once and run often."""

from __future__ import annotations

import functools
import math
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NoReturn, final

from nonsmooth.checks import check_callable, check_kind, is_finite
from nonsmooth.engine.memory import owners
from nonsmooth.engine.memory.tables import places
from nonsmooth.errors import InvalidInput, RunFailed
from nonsmooth.interfaces import Engine
from nonsmooth.model.assembly import lay
from nonsmooth.model.block_ends import BlockEnds
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.checks import check_start
from nonsmooth.model.copying import copied
from nonsmooth.model.laid_out import LaidOut
from nonsmooth.model.other_laws import lay_laws
from nonsmooth.queries.undeclared import Undeclared
from nonsmooth.results.output import Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs.identity import digest
from nonsmooth.runs.keeper import Keeper, KeepsNothing
from nonsmooth.runs.left import Left, Standing
from nonsmooth.runs.loop import Progress, run_engine
from nonsmooth.runs.outcome import reason
from nonsmooth.runs.passed import passed
from nonsmooth.runs.records import Records
from nonsmooth.runs.so_far import Until
from nonsmooth.runs.start import begin, check_arrays, check_closed, check_start_numbers, go_on, restore
from nonsmooth.runs.writer import Writer
from nonsmooth.solution.files import FileError
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import Floats, State
from nonsmooth.system.system import System

_T_END, _INTERVAL, _FIRST, _NEXT, _SPAN, _INDEX, _CAPACITY = places(
    "request.t_end",
    "request.sample_interval",
    "request.sample_start",
    "output.next_sample",
    "request.sample_span",
    "output.sample_index",
    "model.sample_capacity",
).tolist()
_DEFAULT_SAMPLES = 2000
_MOST_SAMPLES = 10**8
"""Samples of the smallest body alone then take more memory than most machines have."""
_MOST_STEPS = 10**10
"""Steps of the longest run: at a microsecond a step, which nothing is quicker than, they take three hours."""
_SAMPLES_AT_ONCE = 0.5
_HELD = 1 << 20
"""Memory that a solution may hold until somebody looks at it [bytes]."""


@final
class Model:
    """A system that is laid out once and run often; :func:`nonsmooth.assemble` makes it.

    Nothing of one run is left for the next.  A model runs in one thread at a time; another thread takes a copy.
    """

    def __init__(self, laid: LaidOut, engine: Engine, start: State, key: Callable[[], str] | None = None) -> None:
        self._laid, self._engine, self._start = laid, engine, start
        self._ends = BlockEnds.of(laid.memory)
        self._blank = Checkpoint.of(laid.memory)
        # for continuing only, and to read all numbers takes as long as to lay them
        self._key = key or functools.cache(partial(digest, laid, engine))
        begin(laid, self._blank, start)
        self._energy = laid.energy()
        self._begun = Checkpoint.of(laid.memory)
        self._records = Records(laid)
        self._runs = threading.Lock()
        self._start_is_valid = False

    @classmethod
    def of(cls, system: System, engine: Engine) -> Model:
        """Return the model of a system, whose start has been looked at.

        Warns
        -----
        UndeclaredOverlap
            If bodies overlap at the start that have no contact, are not joined and not excluded.
        UndeclaredContact
            If a body that nothing ties to another one has no contact at all, and is not excluded from meeting others.

        Raises
        ------
        InvalidInput
            If the engine cannot run it, bodies overlap at the start, a joint is open there, or a guard has no value.
        """
        check_kind("assemble: system", system, System, "Make it by nonsmooth.System([...]).")
        check_kind("engine", engine, Engine, "Give nonsmooth.EventDriven(), or another one with its options.")
        made = cls.anywhere(system, engine)
        made._check_start()
        made._undeclared.warn_of_lone()
        made._undeclared.warn_of_start(made._laid.places())
        return made

    @classmethod
    def anywhere(cls, system: System, engine: Engine) -> Model:
        """Return the model of a system that need not be able to start where it is placed, as it starts elsewhere.

        Raises
        ------
        InvalidInput
            If the engine cannot run it.
        """
        return cls(lay(system, engine), engine, State.at(system))

    def _check_start(self) -> None:
        if not self._start_is_valid:
            check_start(self._laid, self._ends)
            self._start_is_valid = True

    def __repr__(self) -> str:
        """Return what it runs, and by what."""
        return f"Model({self.system!r}, {type(self._engine).__name__})"

    def __reduce__(self) -> NoReturn:
        """Refuse to be pickled and copied by others: what it holds belongs to this process, and to one run at a time.

        Raises
        ------
        InvalidInput
            Always.
        """
        remedy = "Call model.copy() for another thread; in another process, assemble model.system there."
        raise InvalidInput("Model", "must not be pickled, nor copied by the module copy", self, remedy)

    @property
    def system(self) -> System:
        """What it was made from."""
        return self._laid.system

    @property
    def engine(self) -> Engine:
        """What integrates it, with its options."""
        return self._engine

    @property
    def start(self) -> State:
        """Where it starts if nothing else is said: as the bodies were placed when it was made, at t = 0."""
        return self._start

    @property
    def n_events(self) -> int:
        """Events so far of the run that is under way, or of the last one; what ``progress`` may want to tell."""
        return self._records.n_passed

    def copy(self) -> Model:
        """Return a model of its own for another thread; it reads the same tables of meshes.

        Raises
        ------
        InvalidInput
            If the model runs.
        """
        return Model(self._copied(), self._engine, self._start, self._key)

    def with_laws_of(self, system: System) -> Model:
        """Return the model of a system that differs in its laws only, without assembling it.

        Parameters
        ----------
        system : System
            The same bodies, contacts, joints, loads and guards, with laws of the same kinds and other numbers, or that
            need as many of them: :func:`nonsmooth.with_laws` makes one.  It starts where its bodies are placed.

        Raises
        ------
        InvalidInput
            If anything else differs, or the start is not valid, or the model runs.
        """
        check_kind("with_laws_of: system", system, System, "Make it by nonsmooth.with_laws(model.system, ...).")
        laid = lay_laws(self._copied(), system)
        self._engine.prepare(laid)
        made = Model(laid, self._engine, State.at(system))
        check_start(made._laid, made._ends)
        return made

    @functools.cached_property
    def _undeclared(self) -> Undeclared:
        return Undeclared.of(self._laid.system)

    @functools.cached_property
    def _standing(self) -> Standing:
        return Standing.of(self._laid.memory, len(self._laid.system.bodies))

    def _copied(self) -> LaidOut:
        self._seize("copy")
        try:
            self._blank.put(self._laid.memory)
            return replace(self._laid, memory=copied(self._laid.memory))
        finally:
            self._runs.release()

    def _seize(self, what: str) -> None:
        if not self._runs.acquire(blocking=False):
            raise InvalidInput(f"Model.{what}", "must not be called while it runs", "running", "Make a copy before.")

    def run(
        self,
        t_end: float,
        *,
        start: State | None = None,
        sample_interval: float | None = None,
        until: Until | None = None,
        progress: Progress | None = None,
        output: Output | Path | str | None = None,
    ) -> Solution:
        """Run to an end time, or until a condition is met.

        Parameters
        ----------
        t_end : float
            End time [s].
        start : State, optional
            Where to start; :attr:`start` by default.  The ``state`` of a solution of this model, of a copy, or of one
            that was made alike in another process, goes on as if that run had not stopped: with the same events to
            the last bit.  Any other is a start, which may be at any time.
        sample_interval : float, optional
            Time between stored samples [s], the first at the start and a last one where the run ends; a 2000th of the
            run by default.  Events are stored exactly in any case.
        until : callable, optional
            ``until(run)`` is asked after each step and each event whether the run is to end there; it gets a
            :class:`~nonsmooth.runs.so_far.RunSoFar`.  What it raises ends the run and is raised.  Where a function of
            time and state is to be met to the last digit, declare a guard.
        progress : callable, optional
            Called now and then with the time reached and the end time [s].  What it raises ends the run and is raised.
        output : Output, Path or str, optional
            A folder: events and samples are appended to ``solution.zarr`` in it as they come, so that of a run that is
            cut off at most the last second is lost; :func:`nonsmooth.resume` goes on with it.

        Returns
        -------
        Solution
            Of this run; its account of energy goes on with the run, its counters do not.

        Raises
        ------
        InvalidInput
            If a number is not valid, the state is none of this model, the model runs already, or a run was cut off in
            the folder.
        FileError
            If the folder cannot be written to as the run begins.
        RunFailed
            If the run cannot go on, or cannot be written any more; its ``solution`` holds what was computed.
        """
        state = self._start if start is None else start
        check_kind("run: start", state, State, "Give the state of a solution, or State.at(system, ...).")
        _check_calls("run", until, progress)
        if state is not self._start:
            check_arrays(self._laid, state)
            if not self._goes_on(state):
                check_start_numbers(self._laid, state)
        interval = check_times("run", t_end, sample_interval, state.time)
        _check_steps(t_end - state.time, float(self._laid.memory[owners.Tolerance.largest_step]))
        where = None if output is None else Output.to(output)
        self._seize("run")
        try:
            return self._run(t_end, state, interval, sample_interval is None, progress, where, until)
        finally:
            self._runs.release()

    def contact_rates(self, state: State) -> tuple[Floats, Floats]:
        """Return gaps and relative velocities of all contacts in a state; not a number where bodies are far apart.

        Parameters
        ----------
        state : State
            The state; nothing runs.

        Returns
        -------
        gaps, rates : array
            Gaps [m], shape [n_contacts]; velocities of the second body over the first, along the normal and the two
            tangents [m/s], shape [n_contacts, 3].

        Raises
        ------
        InvalidInput
            If the state is none of this model, or the model runs.
        """
        check_arrays(self._laid, state)
        self._seize("contact_rates")
        try:
            begin(self._laid, self._blank, state)
            return self._laid.rates()
        finally:
            self._runs.release()

    def resume(
        self, output: Output | Path | str, *, until: Until | None = None, progress: Progress | None = None
    ) -> Solution:
        """Go on with a run of this model that was cut off, to the same end to the last bit.

        Parameters
        ----------
        output : Output, Path or str
            The folder of its results, which are appended to.
        until : callable, optional
            The condition that the run was given, which no file holds.
        progress : callable, optional
            As for :meth:`run`.

        Returns
        -------
        Solution
            Of the whole run.

        Raises
        ------
        InvalidInput
            If the folder holds no run that was cut off, it is one of another model, it was given a condition and now
            there is none, or the model runs already.
        RunFailed
            As for :meth:`run`.
        """
        _check_calls("resume", until, progress)
        folder = SolutionFolder.held(Output.to(output))
        try:
            state = self._checkpoint(folder, until)
            self._seize("resume")
        except BaseException:
            folder.close()
            raise
        try:
            laid = self._laid
            self._records = records = Records(laid, (folder.events(), folder.rows()))
            restore(laid, self._blank, state)
            energy = state.energy.kinetic_start, state.energy.potential_start
            wall = folder.wall_seconds
            keeper = Writer(folder, records, self._states_from(energy), wall)
            return self._complete(records, Checkpoint.of(laid.memory), energy, progress, keeper, wall, until)
        finally:
            self._runs.release()
            folder.close()

    def _checkpoint(self, folder: SolutionFolder, until: Until | None) -> State:
        """Return the state from which a run of this model goes on; errors as :meth:`resume`."""
        folder.check_cut_off()
        if folder.attributes.get("conditional") and until is None:
            raise InvalidInput(
                f"resume {folder.place}: until",
                "must be given for a run that was to end on a condition, which no file holds",
                None,
                "Give the same function: nonsmooth.resume(folder, until=...).",
            )
        state = folder.cut_to_checkpoint()
        if not self._goes_on(state):
            raise InvalidInput(
                str(folder.place),
                "must hold a run of this model: same system, same numbers, same options",
                "another",
                "Assemble the system that ran.",
            )
        return state

    def _states_from(self, energy: tuple[float, float]) -> Callable[[Checkpoint], State]:
        """Return what makes states of checkpoints, for the account of energy that begins with these [J]."""
        return lambda checkpoint: self._left(energy, checkpoint, 0).state()

    def _left(self, energy: tuple[float, float], before: Checkpoint, told: int) -> Left:
        """Return what has been left by now, so many events after a checkpoint."""
        laid = self._laid
        laid.evaluate()
        now, standing = Checkpoint.of(laid.memory), self._standing
        return Left(laid.system, self._engine, self._key, energy, self._blank, before, now, told, standing)

    def _goes_on(self, state: State) -> bool:
        """Tell whether a run of this model left a state, which goes on then."""
        return state.continuation is not None and state.continuation.model == self._key()

    def _run(
        self,
        t_end: float,
        state: State,
        interval: float,
        is_default: bool,
        progress: Progress | None,
        output: Output | None,
        until: Until | None,
    ) -> Solution:
        laid = self._laid
        records = self._records = Records(laid)
        (floats, integers), begun = laid.memory.cells, None
        if state is self._start:
            begun = self._begun
            begun.put(laid.memory)
            self._check_start()
            energy = self._energy
        elif self._goes_on(state):
            go_on(laid, self._blank, state)
            records.begin_with(state)
            energy = state.energy.kinetic_start, state.energy.potential_start
        else:
            begin(laid, self._blank, state)
            check_closed(laid, state)
            check_start(laid, self._ends)
            energy = laid.energy()
        floats[_T_END], floats[_INTERVAL], integers[_INDEX] = t_end, interval, 0
        floats[_FIRST] = floats[_NEXT] = state.time
        # where a run ends is not to change its steps: all samples by default are fewer than those at once
        floats[_SPAN] = math.inf if is_default else _SAMPLES_AT_ONCE * integers.item(_CAPACITY) * interval
        keeper: Keeper = KeepsNothing()
        if begun is None or output is not None:
            # takes milliseconds where there are many contacts
            begun = Checkpoint.of(laid.memory)
        if output is not None:
            folder = SolutionFolder.created(output, laid.system, self._engine, t_end, laid.n_states, until is not None)
            keeper = Writer(folder, records, self._states_from(energy), 0.0)
        before = laid.places() if self._undeclared.any else []
        solution = self._complete(records, begun, energy, progress, keeper, 0.0, until)
        if self._undeclared.any:
            laid.evaluate()
            self._undeclared.warn_of_end(before, laid.places())
        return solution

    def _complete(
        self,
        records: Records,
        begun: Checkpoint,
        energy: tuple[float, float],
        progress: Progress | None,
        keeper: Keeper,
        wall: float,
        until: Until | None = None,
    ) -> Solution:
        """Run to the end from where the model stands; ``wall`` is what the run took before [s]."""
        laid = self._laid
        began = time.perf_counter()
        try:
            keeper.begin(begun)
            ending = run_engine(self._engine, laid, records, begun, progress, keeper, until)
            said = reason(laid, self._ends, ending, self._engine)
            wall += time.perf_counter() - began
            left, recorded = self._left(energy, ending.checkpoint, ending.told), records.joined(self._engine)
            if said[0] == "done" and (found := passed(laid, recorded.rows)):
                said = "failed", found
            solution = Solution(laid.system, recorded, partial(left.end, said, ending.status, wall, recorded))
            if 2 * self._blank.size > _HELD:
                # reads it: next to a run of so many contacts that takes no time
                _ = solution.end
            failed = said[0] == "failed"
            if not ending.trouble:
                try:
                    keeper.finish(solution)
                except FileError as error:
                    failed = True
                    solution = Solution.known(
                        laid.system, recorded, replace(solution.end, status="failed", message=str(error))
                    )
        except MemoryError as error:
            # nothing that needs more of it than a text
            reached = float(laid.memory[owners.Island.time])
            raise RunFailed(
                f"At t = {reached:.9g} s the memory ran out: {error}. What was computed does not fit there. Give an "
                "output folder, which keeps what is written so far, a shorter run, or fewer samples."
            ) from error
        finally:
            keeper.close()
        if failed:
            raise RunFailed(f"{solution.message} What was computed is in the error's `solution`.", solution)
        return solution


def _check_calls(what: str, until: Until | None, progress: Progress | None) -> None:
    check_callable(f"{what}: until", until, "until(run)")
    check_callable(f"{what}: progress", progress, "progress(t, t_end)")


def _check_steps(duration: float, largest: float) -> None:
    """Raise InvalidInput if a run of a duration [s] has no end in sight, by its largest step [s]."""
    if largest > 0.0 and duration > _MOST_STEPS * largest:
        raise InvalidInput(
            "run: largest step",
            f"must be at least {duration / _MOST_STEPS:.3g} s for a run of {duration:.6g} s, {_MOST_STEPS:.0e} steps",
            largest,
            "It is the least of EventDriven.largest_step and, of prescribed motions, the time scale over "
            "EventDriven.steps_per_period. Run for a shorter time, or let the motion change more slowly.",
        )


def check_times(what: str, t_end: float, sample_interval: float | None, start: float = 0.0) -> float:
    """Return the sample interval of a run [s].

    Raises
    ------
    InvalidInput
        If the end time is not behind the start, or a number is not finite or not positive.
    """
    if not is_finite(t_end) or not t_end > start:
        rule = "must be positive and finite" if start == 0.0 else f"must be finite and after the start at {start:.9g} s"
        raise InvalidInput(f"{what}: t_end", rule, t_end, "Give it in [s].")
    interval = (t_end - start) / _DEFAULT_SAMPLES if sample_interval is None else sample_interval
    if not (is_finite(interval) and interval > 0.0):
        raise InvalidInput(f"{what}: sample_interval", "must be positive and finite", interval, "Give it in [s].")
    if not t_end - start <= _MOST_SAMPLES * interval:
        rule = f"must give at most {_MOST_SAMPLES:.0e} samples within {t_end - start:.6g} s"
        raise InvalidInput(f"{what}: sample_interval", rule, interval, "Take a longer one, in [s].")
    return interval
