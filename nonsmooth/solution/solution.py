"""Solution: everything that a run computed, and why it stopped."""

from __future__ import annotations

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.engine.memory.modes import Cause
from nonsmooth.histories.cones import beyond_cones
from nonsmooth.interfaces import Body
from nonsmooth.model.part_pairs import unchecked_contacts
from nonsmooth.notices import say
from nonsmooth.solution.end import Counters, End
from nonsmooth.solution.energy import EnergyAccount
from nonsmooth.solution.events import Events, words
from nonsmooth.solution.gains import friction_gain
from nonsmooth.solution.graph import TransitionGraph, transition_graph
from nonsmooth.solution.recorded import Recorded
from nonsmooth.solution.state import State
from nonsmooth.solution.track import Track
from nonsmooth.system.asked import body_number
from nonsmooth.system.contact import Contact
from nonsmooth.system.system import System

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from nonsmooth.histories.contact_forces import ContactForces
    from nonsmooth.histories.contact_impulses import ContactImpulses
    from nonsmooth.histories.contact_motion import ContactMotion
    from nonsmooth.histories.energies import Energies
    from nonsmooth.histories.joint_forces import JointForces
    from nonsmooth.histories.poses import Poses
    from nonsmooth.histories.states import States
    from nonsmooth.queries.result import DistanceHistory


@final
@dataclass(frozen=True, eq=False)
class Solution:
    """The result of a run.

    What held at any time of it, next to events on the side after them, is told by :meth:`at`, :meth:`poses`,
    :meth:`contact_motion`, :meth:`contact_forces`, :meth:`joint_forces` and :meth:`energies`.  All of it is read from
    what the run recorded and left when it is first asked for.

    Attributes
    ----------
    system : System
        What was simulated.
    recorded : Recorded
        What it recorded, from which :attr:`events` and :attr:`track` are read.
    find_end : callable
        Returns how it ended; :attr:`end` asks once.
    """

    system: System
    recorded: Recorded
    find_end: Callable[[], End]

    def __reduce__(self) -> tuple[Callable[..., Solution], tuple[Any, ...]]:
        """Let a copy hold what was found, and not what it is found in."""
        return Solution.known, (self.system, self.recorded, self.end)

    @classmethod
    def known(cls, system: System, recorded: Recorded, end: End) -> Solution:
        """Return the solution of a run whose end is known."""
        return cls(system, recorded, lambda: end)

    @functools.cached_property
    def end(self) -> End:
        """How it ended."""
        end = self.find_end()
        # what it was found in may be large
        object.__setattr__(self, "find_end", lambda: end)
        return end

    @property
    def t(self) -> NDArray[np.float64]:
        """Times of the samples [s], shape [n]."""
        return self.recorded.rows[:, 0]

    @property
    def q(self) -> NDArray[np.float64]:
        """Coordinates at the samples, shape [n, n_q]."""
        return self.recorded.rows[:, 1 : 1 + len(self.state.q)]

    @property
    def u(self) -> NDArray[np.float64]:
        """Velocities at the samples, shape [n, n_u]."""
        first = 1 + len(self.state.q)
        return self.recorded.rows[:, first : first + len(self.state.u)]

    @property
    def state(self) -> State:
        """Where the run ended, from which it can go on."""
        return self.end.state

    @property
    def t_end(self) -> float:
        """Time that the run reached [s]."""
        return self.state.time

    @property
    def q_end(self) -> NDArray[np.float64]:
        """Coordinates at that time, shape [n_q]."""
        return self.state.q.copy()

    @property
    def u_end(self) -> NDArray[np.float64]:
        """Velocities at that time, shape [n_u]."""
        return self.state.u.copy()

    @property
    def energy(self) -> EnergyAccount:
        """The energy account."""
        return self.state.energy

    @property
    def counters(self) -> Counters:
        """Steps and times."""
        return self.end.counters

    @property
    def status(self) -> str:
        """How it ended in a word: "done", "suspect", "interrupted" or "failed".

        A suspect run reached its end, but what it found in itself no tolerance explains, as an energy account that is
        open.
        """
        return self.end.status

    @property
    def message(self) -> str:
        """Why it stopped, and what is suspect."""
        return self.end.message

    @property
    def cause(self) -> str:
        """Name of the cause of the engine's own for which it ended, "" if there is none."""
        return self.end.cause

    @property
    def verdict(self) -> dict[str, float]:
        """Numbers by which the engine judges the run, in the units of the keys of ``end.verdict``."""
        return {measure.name: value for measure, value in self.end.verdict.items()}

    @functools.cached_property
    def unseen(self) -> tuple[str, ...]:
        """Names of the contacts of which only their own gap tells that bodies pass into each other.

        All other pairs of bodies between which contacts are declared are looked at as wholes, too.
        """
        return tuple(unchecked_contacts(self.system.contacts))

    @functools.cached_property
    def impulses_beyond_cone(self) -> int:
        """How many impulses of events lie outside of their friction cones.

        :attr:`nonsmooth.histories.contact_impulses.ContactImpulses.beyond_cone` says which.
        """
        events = self.events
        normal, friction = events.listed_impulse[:, 0], events.listed_impulse[:, 1:]
        speed = np.full(len(normal), np.nan)
        outside = beyond_cones(self.system.contacts, events.listed, events.first, normal, friction, speed)
        return int(np.count_nonzero(outside))

    @functools.cached_property
    def friction_gain(self) -> float:
        """Energy that sustained friction added [J], summed over the intervals between samples and events.

        Zero unless forces are averaged, or a friction law stores energy in its contact.
        """
        return friction_gain(self.track, self.events)

    def __repr__(self) -> str:
        """Return how it ended, and how much there is of it."""
        unseen = f", {len(self.unseen)} contacts seen by their gaps only" if self.unseen else ""
        outside = self.impulses_beyond_cone
        unseen += f", {outside} impulses outside of their friction cones" if outside else ""
        # below what the account leaves open it is round-off
        gained = self.friction_gain if self.friction_gain > self.energy.unexplained else 0.0
        unseen += f", {gained:.1e} J added by friction" if gained else ""
        return (
            f"Solution({self.status} at t = {self.t_end:.9g} s: {self.message}; {len(self.t)} samples, "
            f"{len(self.events)} events, energy residual {self.energy.residual:.1e}{unseen})"
        )

    @property
    def events(self) -> Events:
        """All events."""
        return self.recorded.events

    @functools.cached_property
    def track(self) -> Track:
        """The states that it stored, whole."""
        return Track.of(self.recorded.rows, self.state, self.recorded.engine)

    @property
    def knows_modes(self) -> bool:
        """Whether modes and impulses are known: there are no contacts, or the engine records them."""
        return not self.system.contacts or self.recorded.engine.records_contacts

    def _check_recorded(self, name: str, what: str = "modes") -> None:
        from nonsmooth.histories.recorded import check_recorded

        check_recorded(f"Solution.{name}", what, self.system, self.recorded.engine)

    @property
    def modes(self) -> dict[str, float]:
        """Share of the time spent in each mode word; impacts are listed with 0, as they take no time.

        Modes and impulses are those of the engine.  Of one that records none they are refused by InvalidInput, here
        and wherever a history holds them.
        """
        self._check_recorded("modes")
        shares: dict[str, float] = {}
        if len(self.events) == 0:
            return shares
        durations = np.diff(np.append(self.events.time, self.t_end))
        total = float(durations.sum())
        for word, duration in zip(self.events.words("after"), durations, strict=True):
            shares[word] = shares.get(word, 0.0) + (float(duration) / total if total > 0.0 else 0.0)
        impacts = np.isin(self.events.cause, (Cause.IMPACT, Cause.PAINLEVE, Cause.JAM))
        for word in words(self.events.during[impacts]):
            shares.setdefault(word, 0.0)
        return dict(sorted(shares.items(), key=lambda item: -item[1]))

    def transitions(self) -> list[tuple[float, str, str, str, str]]:
        """Return (time [s], cause, mode before, mode during, mode after) of every event."""
        self._check_recorded("transitions")
        columns = (self.events.words(which) for which in ("before", "during", "after"))
        return list(zip(self.events.time.tolist(), self.events.causes(), *columns, strict=True))

    def triggers(self) -> list[str]:
        """Return the name of the contact, or of the guard, that caused each event; "" at the start."""
        return self.events.triggers(self.system.names.contacts, self.system.names.guards)

    def transition_graph(self) -> TransitionGraph:
        """Return the modes visited, their shares of the time, and how often which cause led from one to another."""
        self._check_recorded("transition_graph")
        return transition_graph(self.events, self.system.names.contacts, self.t_end)

    def of(self, body: Body | str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the samples of q and u of one body, shapes [n, body.n_q] and [n, body.n_u].

        Raises
        ------
        InvalidInput
            As :meth:`offsets`.
        """
        one = self.system.bodies[body_number("Solution.of", body, self.system)]
        i_q, i_u = self.offsets(one)
        return self.q[:, i_q : i_q + one.n_q], self.u[:, i_u : i_u + one.n_u]

    def offsets(self, body: Body | str) -> tuple[int, int]:
        """Return where the coordinates and the velocities of a body, or of that of a name, begin.

        Raises
        ------
        InvalidInput
            If the system has no such body.
        """
        before = self.system.bodies[: body_number("Solution.offsets", body, self.system)]
        return sum(one.n_q for one in before), sum(one.n_u for one in before)

    def mode_words(self, times: ArrayLike) -> list[str]:
        """Return the mode word that holds just after each of the times [s].

        Raises
        ------
        InvalidInput
            If a time is not within the run, or the engine records no modes.
        """
        from nonsmooth.histories.times import read_times

        self._check_recorded("mode_words")
        row = np.atleast_1d(read_times("Solution.mode_words", self, times))
        index = np.searchsorted(self.events.time, row, side="right") - 1
        return words(self.events.codes_after(index))

    def at(self, times: ArrayLike | None = None) -> States:
        """Return the states at times: coordinates, velocities, modes, inner states of laws.

        At the instant of an event it is the state after the last event there.  Between two stored states, samples or
        events, the flow goes on from the earlier one, by steps of the run's own tolerance.

        Parameters
        ----------
        times : float or array, optional
            Times within the run [s], in any order, shape [n]; those of the samples by default.  Of a single float the
            arrays that are returned lack the axis of times.

        Raises
        ------
        InvalidInput
            If a time is not within the run, or contacts have been declared since.
        """
        from nonsmooth.histories.states import States

        return States.of(self, times)

    def poses(self, body: Body | str, times: ArrayLike | None = None) -> Poses:
        """Return origins and axes of all frames of a body, or of that of a name, at times, those of :meth:`at`.

        Raises
        ------
        InvalidInput
            As :meth:`at`, or if the system has no such body.
        """
        from nonsmooth.histories.poses import Poses

        return Poses.of(self, body, times)

    def contact_forces(self, times: ArrayLike | None = None) -> ContactForces:
        """Return points, normals, normal forces and friction of the closed contacts at times, those of :meth:`at`.

        They are forces between events; the impulses of impacts are in ``events``.  Where several sets of forces give
        the same motion, it is one that keeps all bounds.
        """
        from nonsmooth.histories.contact_forces import ContactForces

        return ContactForces.of(self, times)

    def contact_impulses(self) -> ContactImpulses:
        """Return points, normals and impulses of the contacts of all events, in world axes."""
        self._check_recorded("contact_impulses", "impulses")
        from nonsmooth.histories.contact_impulses import ContactImpulses

        return ContactImpulses.of(self)

    def contact_motion(
        self, times: ArrayLike | None = None, contacts: Sequence[Contact | str | int] | None = None
    ) -> ContactMotion:
        """Return gaps, normal velocities and slip of contacts, open ones too, at times, those of :meth:`at`.

        Parameters
        ----------
        times : float or array, optional
            Times within the run [s]; those of the samples by default.
        contacts : sequence of Contact, str or int, optional
            Which contacts, by themselves, their names or numbers; all by default.

        Raises
        ------
        InvalidInput
            As :meth:`at`, or if the system has no such contact.
        """
        from nonsmooth.histories.contact_motion import ContactMotion

        return ContactMotion.of(self, times, contacts)

    def joint_forces(self, times: ArrayLike | None = None) -> JointForces:
        """Return forces and moments that the joints bear at times, which are those of :meth:`at`.

        Joints are those of ``System.joint``, and not what generalised coordinates of a mechanism stand for.
        """
        from nonsmooth.histories.joint_forces import JointForces

        return JointForces.of(self, times)

    def energies(self, times: ArrayLike | None = None) -> Energies:
        """Return kinetic and potential energy, and the account of works and losses, at times, those of :meth:`at`."""
        from nonsmooth.histories.energies import Energies

        return Energies.of(self, times)

    def distances(
        self, first: Body | str, second: Body | str, times: ArrayLike | None = None, *, by: str | None = None
    ) -> DistanceHistory:
        """Return how far two bodies are from each other at times: gap, points, normal, and how they were found.

        Parameters
        ----------
        first, second : Body or str
            Bodies of the system, or their names; all of their shapes count.
        times : float or array, optional
            Times within the run [s]; those of the samples by default.
        by : str, optional
            One way to find it (:func:`nonsmooth.distance`).

        Raises
        ------
        InvalidInput, NoDistance, MissingPackagesError
            As :func:`nonsmooth.distance`, or if the system has no such body, or a time is not within the run.
        """
        from nonsmooth.histories.distances import distances

        return distances(self, first, second, times, by)

    def to_html(self, path: Path | str, *, title: str = "", most_knots: int = 4000) -> Path:
        """Write a page that plays the run in a browser, from the file alone; return its path.

        Parameters
        ----------
        path : Path or str
            The file, which is replaced if it is there.
        title : str, optional
            What stands over it.
        most_knots : int, optional
            At how many times, besides the instants of events, the bodies are placed; between them they move straight.

        Raises
        ------
        InvalidInput
            As :meth:`at`, or if the path or a number is wrong.
        FileError
            If the file cannot be written.
        """
        from nonsmooth.solution.pages import write

        return write(self, path, title, most_knots)

    def view(self, *, title: str = "", most_knots: int = 4000) -> Path:
        """Play the run in the browser; return the path of the page, which :meth:`to_html` tells about.

        Where no browser is found, a line on standard error says which file to open.
        """
        from nonsmooth.solution.pages import not_opened, show

        path, opened = show(self, title, most_knots)
        if not opened:
            say(not_opened(path))
        return path

    def _repr_html_(self) -> str:
        """Return the page in a frame, for notebooks."""
        from nonsmooth.solution.pages import framed

        return framed(self)

    def plot(self) -> Figure:
        """Return a figure with an overview of the run, which has the panels that it has something for.

        Modes, gaps, forces and impulses of the contacts that are busiest, energies, and the path of the body that goes
        farthest.  Each panel is a function of :mod:`nonsmooth.plot`, to be composed otherwise.

        Raises
        ------
        MissingPackagesError
            If matplotlib is not installed.
        """
        from nonsmooth.plot.overview import overview

        return overview(self)

    def export(self, path: Path | str, **options: Any) -> Path:
        """Write the run for other programs, in the format that the suffix of the path names; return the path.

        Parameters
        ----------
        path : Path or str
            The file, which is replaced if it is there: ".glb" is a scene with animation, ".pvd" a series for ParaView,
            ".gif", ".webp", ".png" and ".mp4" are moving pictures, ".csv" is a table.
        **options
            Those of the format: ``most_knots`` of :class:`~nonsmooth.export.glb.Glb`, ``count`` of
            :class:`~nonsmooth.export.vtk.Vtk`, ``view``, ``speed``, ``frames_per_second`` and ``size`` of
            :class:`~nonsmooth.export.movie.Movie`, ``series`` of :class:`~nonsmooth.solution.csv_format.Csv`.

        Raises
        ------
        InvalidInput
            If there is no such format or option, or the path cannot be written to; nothing is computed then.
        MissingPackagesError
            If pictures or tables need something that is not installed, such as ffmpeg.
        FileError
            If the file cannot be written.
        """
        from nonsmooth.solution.exports import exporter

        return exporter(path, **options)(self)

    def to_xarray(self) -> xarray.Dataset:
        """Return samples and events as one dataset with units and labels.

        What belongs to the contacts of an event is ragged: ``event_size`` says how many stand along ``listing``.
        """
        from nonsmooth.solution.dataset import to_dataset

        return to_dataset(self)
