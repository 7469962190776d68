"""Model: a system that is laid out in memory once, and run often.

Layout and compilation of plug-ins take much longer than many a run. A model does both once. Before each run its memory
gets back the content that it had before the first one, so that runs do not depend on each other.
"""

from __future__ import annotations

import contextlib
import functools
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import NoReturn, final

from nonsmooth.checks import check_count, check_kind
from nonsmooth.engine.memory import owners
from nonsmooth.errors import STUCK, InvalidInput, RunFailed
from nonsmooth.interfaces import Engine
from nonsmooth.model.assembly import lay
from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.model.checks import check_start
from nonsmooth.model.laid_out import LaidOut, copied
from nonsmooth.model.other_laws import lay_laws
from nonsmooth.queries.undeclared import Undeclared
from nonsmooth.results.output import Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs.checks import (
    check_arrays,
    check_calls,
    check_closed,
    check_numbers,
    check_steps,
    check_times,
    checked_request,
)
from nonsmooth.runs.engine_driver import UNLIMITED
from nonsmooth.runs.final_state import FinalState, FixedPlaces, UnreadEnd
from nonsmooth.runs.folder_sink import FolderSink, OutputSink
from nonsmooth.runs.identity import digest
from nonsmooth.runs.loop import Callbacks, EngineLoop, Progress
from nonsmooth.runs.outcome import RunOutcome, interpenetration, outcome
from nonsmooth.runs.records import Records
from nonsmooth.runs.samples import places_at_samples
from nonsmooth.runs.so_far import Until
from nonsmooth.runs.start import begin, continue_run, resume_run, write_first_sample, write_request
from nonsmooth.solution.end import RunRequest, RunStatus
from nonsmooth.solution.solution import Solution
from nonsmooth.solution.state import Floats, State
from nonsmooth.storage.files import FileError
from nonsmooth.system.system import System

_LARGEST_UNREAD = 1 << 20
"""Largest size of the two checkpoints that a solution keeps, from which its end is evaluated at the first use [bytes].

If they are larger, the end is evaluated at once and they are freed, because a study holds many solutions at once.
"""


@final
class Model:
    """A system that is laid out once and run often; :func:`nonsmooth.assemble` makes it.

    Runs do not depend on earlier runs.  A model runs in one thread at a time; another thread takes a copy.
    """

    def __init__(self, laid: LaidOut, engine: Engine, start: State, key: Callable[[], str] | None = None) -> None:
        """Store the memory of ``laid``, on which nothing ran yet, before and after the default start is written to it.

        ``key`` computes the digest of an equal model.
        """
        self._laid, self._engine, self._start = laid, engine, start
        self._blank = Checkpoint.of(laid.memory)
        # only continued runs need the digest, and it takes as long as the layout
        self._key = key or functools.cache(partial(digest, laid, engine))
        begin(laid, self._blank, start)
        self._start_energy = laid.energy()
        self._start_checkpoint = Checkpoint.of(laid.memory)
        self._records = Records(laid)
        self._runs = threading.Lock()
        # called while the memory holds the default start; only the first call that succeeds does anything
        self._check_start = functools.cache(partial(check_start, laid))

    @classmethod
    def of(cls, system: System, engine: Engine) -> Model:
        """Model of a system, whose start is checked.

        Warns
        -----
        UndeclaredOverlap
            If bodies overlap at the start that have no contact, are not joined and not excluded.
        UndeclaredContact
            If a body without joint or load has no contact at all, and is not excluded from contacts with others.

        Raises
        ------
        InvalidInput
            If the engine cannot run it, bodies overlap at the start, a joint is open there, or a guard has no value.
        """
        check_kind("assemble: system", system, System, "Make it by nonsmooth.System([...]).")
        check_kind("engine", engine, Engine, "Give nonsmooth.EventDriven(), or another one with its options.")
        made = cls.anywhere(system, engine)
        # the memory of a new model holds the default start
        made._check_start()
        # bodies without any contact, then bodies that overlap and have no contact with each other
        made._pairs_without_contact.warn_of_lone()
        made._pairs_without_contact.warn_of_start(made._laid.places())
        return made

    @classmethod
    def anywhere(cls, system: System, engine: Engine) -> Model:
        """Model of a system whose start is not checked, because its runs start elsewhere.

        Raises
        ------
        InvalidInput
            If the engine cannot run it.
        """
        return cls(lay(system, engine), engine, State.at(system))

    def __repr__(self) -> str:
        """The system, and the class of the engine."""
        return f"Model({self.system!r}, {type(self._engine).__name__})"

    def __reduce__(self) -> NoReturn:
        """Refuse to be pickled or copied by :mod:`copy`: the memory holds addresses of this process.

        Raises
        ------
        InvalidInput
            Always.
        """
        remedy = "Call model.copy() for another thread; in another process, assemble model.system there."
        raise InvalidInput("Model", "must not be pickled, nor copied by the module copy", self, remedy)

    @property
    def system(self) -> System:
        """The system that was assembled."""
        return self._laid.system

    @property
    def engine(self) -> Engine:
        """The engine that integrates it, with its options."""
        return self._engine

    @property
    def start(self) -> State:
        """The start by default: the bodies as they were placed, at t = 0."""
        return self._start

    @property
    def n_events(self) -> int:
        """Number of events so far of the current run, or of the last one; ``progress`` may show it."""
        return self._records.n_events

    def copy(self) -> Model:
        """A copy for another thread; it reads the same tables of meshes.

        Raises
        ------
        InvalidInput
            If the model runs.
        """
        return Model(self._blank_copy(), self._engine, self._start, self._key)

    def with_laws_of(self, system: System) -> Model:
        """Model of a system that differs in its laws only.

        It is not assembled if the same contacts share their laws as before, which saves most of the time.

        Parameters
        ----------
        system : System
            The same bodies, contacts, joints, loads and guards.  The laws are of the same kinds with other numbers, or
            have as many numbers: :func:`nonsmooth.with_laws` makes one.  It starts where its bodies are placed.

        Raises
        ------
        InvalidInput
            If anything else differs, the start is not valid, or the model runs.
        """
        check_kind("with_laws_of: system", system, System, "Make it by nonsmooth.with_laws(model.system, ...).")
        made = Model(lay_laws(self._blank_copy(), system, self._engine), self._engine, State.at(system))
        made._check_start()
        return made

    def run(
        self,
        t_end: float,
        *,
        start: State | None = None,
        sample_interval: float | None = None,
        until: Until | None = None,
        most_steps: int | None = None,
        progress: Progress | None = None,
        output: Output | Path | str | None = None,
    ) -> Solution:
        """Run to an end time, or until a condition is met.

        Parameters
        ----------
        t_end : float
            End time [s].
        start : State, optional
            State at the start; :attr:`start` by default.  From the ``state`` of a solution of this model, of a copy of
            the model, or of an equal model in another process, the run continues as if it had not stopped: with the
            same events to the last bit.  Any other state is a new start, which may be at any time.
        sample_interval : float, optional
            Time between stored samples [s], from the start on; by default a 2000th of the run.  The end of the run is
            a sample, too.  Events are stored exactly in any case.
        until : callable, optional
            ``until(run)``, called after each step and each event with a
            :class:`~nonsmooth.runs.so_far.RunSoFar`.  True ends the run there; an exception ends the run and is
            raised.  To end a run exactly at a zero of a function of time and state, declare a guard.
        most_steps : int, optional
            Accepted steps of the flow after which the run is stopped, at the same step on every machine.
        progress : callable, optional
            ``progress(time, t_end)`` [s], called repeatedly.  An exception ends the run and is raised.
        output : Output, Path or str, optional
            A folder.  Events and samples are appended to ``solution.zarr`` in it during the run, so that a run that is
            cut off loses at most the last second; :func:`nonsmooth.resume` continues it.

        Returns
        -------
        Solution
            The solution of this run.  Its energy account includes the runs that this one continues; its counters do
            not.

        Raises
        ------
        InvalidInput
            If an argument is not valid; if the state is of another model; if the model runs already; or if the folder
            holds a run that is under way or was cut off.
        FileError
            If the folder cannot be written to as the run begins.
        RunFailed
            If the run cannot continue, or cannot be written any more; its ``solution`` holds the results until then.
        """
        state = self._start if start is None else start
        check_kind("run: start", state, State, "Give the state of a solution, or State.at(system, ...).")
        check_calls("run", until, progress)
        if most_steps is not None:
            check_count("run: most_steps", most_steps, "must be a positive whole number of steps", "Leave it out.")
        # the default start is valid; a state that continues a run gives the memory of that run, not its arrays
        if state is not self._start:
            check_arrays(self._laid, state)
            if not self._continues(state):
                check_numbers(self._laid, state)
        interval = check_times("run", t_end, sample_interval, state.time)
        check_steps(t_end - state.time, float(self._laid.memory[owners.Tolerance.largest_step]))
        request = RunRequest(t_end, state.time, interval, sample_interval is None, until is not None)
        folder = None if output is None else Output.to(output)
        with self._reserved("run"):
            return self._run(request, state, folder, Callbacks(progress, until, most_steps or UNLIMITED))

    def contact_rates(self, state: State) -> tuple[Floats, Floats]:
        """Gaps and relative velocities of all contacts in a state; nan for bodies that are far apart.

        Parameters
        ----------
        state : State
            The state; nothing runs.

        Returns
        -------
        gaps, rates : array
            Gaps [m], shape [n_contacts]; velocities of the second body relative to the first, along the normal and the
            two tangents [m/s], shape [n_contacts, 3].

        Raises
        ------
        InvalidInput
            If the state is of another model, or the model runs.
        """
        check_arrays(self._laid, state)
        with self._reserved("contact_rates"):
            begin(self._laid, self._blank, state)
            return self._laid.rates()

    def resume(
        self, output: Output | Path | str, *, until: Until | None = None, progress: Progress | None = None
    ) -> Solution:
        """Continue a run of this model that was cut off, to the same end to the last bit.

        Parameters
        ----------
        output : Output, Path or str
            The folder of its results, to which the rest is appended.
        until : callable, optional
            The condition of the run, which no file holds.
        progress : callable, optional
            As for :meth:`run`.

        Returns
        -------
        Solution
            The solution of the whole run.

        Raises
        ------
        InvalidInput
            If the folder holds no run that was cut off or one of another model, its condition is missing, or the model
            runs already.
        RunFailed
            As for :meth:`run`.
        """
        check_calls("resume", until, progress)
        with contextlib.closing(SolutionFolder.held(Output.to(output))) as folder, self._reserved("resume"):
            request = checked_request(folder, until)
            state = self._state_to_resume(folder)
            # this removes all that is newer than the checkpoint; what is left are the results before it
            folder.cut_to_checkpoint()
            laid = self._laid
            self._records = Records(laid, folder.stored())
            resume_run(laid, self._blank, state)
            write_request(laid.memory, request)
            # the checkpoint has the time of the next sample. The energy account is that of the whole run
            energy, wall = (state.energy.kinetic_start, state.energy.potential_start), folder.wall_seconds
            sink = FolderSink(folder, self._records, self._states_from(energy), wall)
            start = Checkpoint.of(laid.memory)
            loop = EngineLoop(self._engine, laid, self._records, start, sink, Callbacks(progress, until))
            return self._complete(loop, energy, wall)

    @functools.cached_property
    def _pairs_without_contact(self) -> Undeclared:
        """Pairs of bodies that may overlap, without contact and not excluded: a run warns of their overlap."""
        return Undeclared.of(self._laid.system)

    @functools.cached_property
    def _places(self) -> FixedPlaces:
        """Positions of the numbers of a state in a checkpoint of this model."""
        return FixedPlaces.of(self._laid.memory)

    @contextlib.contextmanager
    def _reserved(self, method: str) -> Iterator[None]:
        """Reserve the memory for a call of a method, also against a callback or another thread that calls one.

        Raises
        ------
        InvalidInput
            If the model runs.
        """
        if not self._runs.acquire(blocking=False):
            raise InvalidInput(f"Model.{method}", "must not be called while it runs", "running", "Make a copy before.")
        try:
            yield
        finally:
            self._runs.release()

    def _blank_copy(self) -> LaidOut:
        """The layout before any run, in a new memory.

        The memory of the model itself is reset, too. This loses nothing, as each run writes its start first.
        """
        with self._reserved("copy"):
            self._blank.put(self._laid.memory)
            return copied(self._laid)

    def _continues(self, state: State) -> bool:
        """True if a state was left by a run of this model or of an equal one, so that a run from there continues it."""
        return state.continuation is not None and state.continuation.model == self._key()

    def _state_to_resume(self, folder: SolutionFolder) -> State:
        """State of the run in a folder at its last checkpoint. The folder stays as it is. Errors as :meth:`resume`."""
        state = folder.state_at_checkpoint()
        if not self._continues(state):
            raise InvalidInput(
                str(folder.place),
                "must hold a run of this model: same system, same numbers, same options",
                "another",
                "Assemble the system that ran.",
            )
        return state

    def _states_from(self, start_energy: tuple[float, float]) -> Callable[[Checkpoint], State]:
        """Function that makes the state of a checkpoint, for the sink; its account starts at ``start_energy`` [J]."""
        # kinetic and potential energy; the memory holds the checkpoint, so no event is after it
        return lambda checkpoint: self._final_state(start_energy, checkpoint, n_known_events=0).state()

    def _final_state(self, start_energy: tuple[float, float], resumable: Checkpoint, n_known_events: int) -> FinalState:
        """The state of the memory now, ``n_known_events`` events after the checkpoint ``resumable``.

        The energy account starts at ``start_energy``, kinetic and potential [J].
        """
        laid = self._laid
        # the energies of bodies are numbers of their blocks
        laid.evaluate()
        return FinalState(
            laid.system,
            self._engine,
            self._key,
            start_energy,
            self._blank,
            resumable,
            Checkpoint.of(laid.memory),
            n_known_events,
            self._places,
        )

    def _run(self, request: RunRequest, state: State, output: Output | None, callbacks: Callbacks) -> Solution:
        """Run from a state, while the memory is reserved; errors as :meth:`run`.

        Bodies without a contact that overlap at a sample, but not at the start, cause a warning.
        """
        laid = self._laid
        self._records = Records(laid)
        # kinetic and potential energy at the start of the energy account
        energy = self._put_start(state)
        write_request(laid.memory, request)
        write_first_sample(laid.memory, request)
        # with many contacts a checkpoint takes milliseconds, so all runs from the default start use the checkpoint that
        # was taken once. It lacks the time of the first sample, so a run with a folder needs a checkpoint of its own
        is_known = state is self._start and output is None
        start = self._start_checkpoint if is_known else Checkpoint.of(laid.memory)
        sink = OutputSink()
        if output is not None:
            folder = SolutionFolder.created(output, laid.system, self._engine, request, laid.n_states)
            sink = FolderSink(folder, self._records, self._states_from(energy), wall=0.0)
        # places of the bodies before the run
        before = laid.places() if self._pairs_without_contact.any else []
        loop = EngineLoop(self._engine, laid, self._records, start, sink, callbacks)
        solution = self._complete(loop, energy, wall=0.0)
        if self._pairs_without_contact.any:
            places = places_at_samples(laid, solution.recorded.rows, self._pairs_without_contact.least_move)
            self._pairs_without_contact.warn_of_run(before, places)
        return solution

    def _put_start(self, state: State) -> tuple[float, float]:
        """Put a state into the memory. Return kinetic and potential energy [J] at the start of the energy account.

        If a run continues an earlier run, its energy account begins at the start of the earlier run. The engine records
        no start event in such a run, so this method adds the start event.
        """
        laid = self._laid
        if state is self._start:
            self._start_checkpoint.put(laid.memory)
            # checked at the first run if assembly did not check it
            self._check_start()
            return self._start_energy
        if self._continues(state):
            continue_run(laid, self._blank, state)
            self._records.add_start(state)
            return state.energy.kinetic_start, state.energy.potential_start
        begin(laid, self._blank, state)
        check_closed(laid, state)
        check_start(laid)
        return laid.energy()

    def _complete(self, loop: EngineLoop, energy: tuple[float, float], wall: float) -> Solution:
        """Run to the end from the start of a loop, and raise RunFailed with the solution if the run failed.

        ``energy`` are kinetic and potential energy at the start of the energy account [J]; ``wall`` is the wall time
        that the run took in earlier processes [s].
        """
        laid, clock, records = self._laid, time.perf_counter(), loop.records
        try:
            loop.sink.begin(loop.start)
            ending = loop.run()
            found = outcome(laid, ending, self._engine)
            wall += time.perf_counter() - clock
            final = self._final_state(energy, ending.checkpoint, ending.n_known_events)
            recorded = records.joined(self._engine)
            if found.status == RunStatus.DONE and (overlap := interpenetration(laid, recorded.rows)):
                found = RunOutcome(RunStatus.FAILED, overlap)
            unread = UnreadEnd(final, found, ending.status, wall, recorded)
            # an UnreadEnd keeps two checkpoints of the memory; if they are large, evaluate the end now to free them
            is_large = 2 * self._blank.size > _LARGEST_UNREAD
            solution = Solution(laid.system, recorded, unread.read() if is_large else unread)
            has_failed = found.status == RunStatus.FAILED
            # results that cannot be written are in memory, so the error gets the solution; after a failed write the
            # sink gets nothing more
            try:
                if not ending.output_error:
                    loop.sink.finish(solution)
            except FileError as error:
                has_failed = True
                end = replace(solution.end, status=RunStatus.FAILED, message=str(error))
                solution = Solution(laid.system, recorded, end)
        except MemoryError as error:
            raise self._out_of_memory(error) from error
        finally:
            loop.sink.close()
        if has_failed:
            raise RunFailed(f"{solution.message} What was computed is in the error's `solution`; {STUCK}.", solution)
        return solution

    def _out_of_memory(self, error: MemoryError) -> RunFailed:
        """The error of a run whose results do not fit into memory. It has no solution, because that would not fit."""
        reached = float(self._laid.memory[owners.Island.time])
        return RunFailed(
            f"At t = {reached:.9g} s the memory ran out: {error}. The results do not fit. Give an output folder, which "
            "keeps what is written so far, or take a shorter run or fewer samples."
        )
