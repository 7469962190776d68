"""Solution: the result of a run."""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from nonsmooth.errors import STUCK
from nonsmooth.interfaces import Body
from nonsmooth.notices import say
from nonsmooth.readable import Readable
from nonsmooth.solution.end import Counters, End, EndSource, RunStatus
from nonsmooth.solution.energy import EnergyAccount
from nonsmooth.solution.events import Events
from nonsmooth.solution.recorded import Recorded, Track
from nonsmooth.solution.state import State
from nonsmooth.system.system import System

if TYPE_CHECKING:
    import xarray
    from matplotlib.figure import Figure

    from nonsmooth.histories.history import History
    from nonsmooth.histories.request import Parts
    from nonsmooth.histories.variables import Variable


@final
@dataclass(frozen=True, eq=False, match_args=False)
class Solution(metaclass=Readable):
    """The result of a run: samples, events, energies, and the history of any quantity.

    Attributes
    ----------
    system : System
        The system that ran.
    recorded : Recorded
        Samples and events as the engine recorded them.
    ending : EndSource
        Source from which :attr:`end` is read when it is first needed.
    """

    system: System
    recorded: Recorded
    ending: EndSource

    def __reduce__(self) -> tuple[Callable[..., Solution], tuple[Any, ...]]:
        """Pickle the end of the run as it is read, without its source, which keeps the memory of the model."""
        return Solution, (self.system, self.recorded, self.end)

    @property
    def t(self) -> NDArray[np.float64]:
        """Times of the samples [s], shape [n]."""
        return self.recorded.rows[:, 0]

    @property
    def q(self) -> NDArray[np.float64]:
        """Coordinates of all bodies, in their order, at the samples, shape [n, n_q]."""
        return self.recorded.rows[:, 1 : 1 + len(self.state.q)]

    @property
    def u(self) -> NDArray[np.float64]:
        """Velocities of all bodies, in their order, at the samples, shape [n, n_u]."""
        first = 1 + len(self.state.q)
        return self.recorded.rows[:, first : first + len(self.state.u)]

    def of(self, body: Body | str) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Samples of q and u of a body, given itself or by name; shapes [n, body.n_q] and [n, body.n_u]."""
        from nonsmooth.histories.request import numbers_of

        (number,) = numbers_of("Solution.of", self.system, ["body"], [body])["body"]
        one, before = self.system.bodies[number], self.system.bodies[:number]
        i_q, i_u = sum(other.n_q for other in before), sum(other.n_u for other in before)
        return self.q[:, i_q : i_q + one.n_q], self.u[:, i_u : i_u + one.n_u]

    def at(self, times: ArrayLike | None = None) -> History:
        """States at times: the history of "q", "u", "law_state" and, if the engine records contacts, "mode"."""
        known = self.recorded.engine.records_contacts or not self.system.contacts
        return self.history("q", "u", "law_state", *["mode"] * known, times=times)

    def history(self, *names: str | Variable, times: ArrayLike | None = None, of: Parts | None = None) -> History:
        """Quantities over time: ``solution.history("gap", "normal_force")["gap"]`` is an array [n, n_contacts].

        At the time of an event, the values are those after the last event there.  Between stored states, the engine
        integrates from the stored state before, with the tolerances of the run.

        Parameters
        ----------
        *names : str or Variable
            Names of the table that ``print(nonsmooth.histories.variables.variables())`` shows, or your own variables.
        times : float or array, optional
            Times within the run [s], in any order, shape [n]; by default the samples.  At a single time the arrays
            have no axis of time.
        of : contact, body or joint, or a sequence of them, optional
            The objects, their names or numbers; by default all.

        Raises
        ------
        InvalidInput
            A name is unknown, a time is outside of the run, or the engine of the run does not know the quantity.
        """
        from nonsmooth.histories.reading import read_history

        return read_history(self, names, times, of)

    @property
    def events(self) -> Events:
        """All events: times, causes, contacts, modes, impulses and energies."""
        return self.recorded.events

    @property
    def energy(self) -> EnergyAccount:
        """Energy account of the run."""
        return self.state.energy

    @property
    def status(self) -> RunStatus:
        """How the run ended, such as ``RunStatus.DONE``, which equals "done"."""
        return RunStatus(self.end.status)

    @property
    def message(self) -> str:
        """Why the run ended, and which check failed."""
        return self.end.message

    @property
    def state(self) -> State:
        """State at the end, from which another run can continue."""
        return self.end.state

    @property
    def t_end(self) -> float:
        """Time at the end [s]."""
        return self.state.time

    @property
    def q_end(self) -> NDArray[np.float64]:
        """Coordinates at the end, shape [n_q]."""
        return self.state.q.copy()

    @property
    def u_end(self) -> NDArray[np.float64]:
        """Velocities at the end, shape [n_u]."""
        return self.state.u.copy()

    @property
    def counters(self) -> Counters:
        """Numbers of steps and impacts, and wall time."""
        return self.end.counters

    @functools.cached_property
    def end(self) -> End:
        """End of the run: state, counters, status and verdict of the engine."""
        # read at the first use: reading takes some microseconds, as long as a short run, and many studies never need it
        return self.ending.read()

    @functools.cached_property
    def track(self) -> Track:
        """Stored states at the samples and at the end."""
        return Track.of(self.recorded.rows, self.state, self.recorded.engine)

    def plot(self) -> Figure:
        """Figure with an overview: modes, gaps, forces, impulses, energies and a path; needs matplotlib."""
        from nonsmooth.plot.overview import overview

        return overview(self)

    def view(self, *, title: str = "", most_knots: int = 4000) -> Path:
        """Play the run in the browser; returns the path of the page, as :meth:`to_html` writes it."""
        from nonsmooth.solution.pages import not_opened, show

        path, opened = show(self, title, most_knots)
        if not opened:
            say(not_opened(path))
        return path

    def to_html(self, path: Path | str, *, title: str = "", most_knots: int = 4000) -> Path:
        """Write a page that plays the run in a browser, without a network; returns its path.

        The bodies are placed at all events and at ``most_knots`` other times at most, and move straight between them.
        """
        from nonsmooth.solution.pages import write

        return write(self, path, title, most_knots)

    def export(self, path: Path | str, **options: Any) -> Path:
        """Write the run for other programs, in the format of the suffix; returns the path.

        ".glb" is an animated scene, ".pvd" a series for ParaView, ".gif", ".webp", ".png" and ".mp4" are moving
        pictures, ".csv" is a table.  Options are ``most_knots`` (glb), ``count`` (pvd), ``series`` (csv), ``view``,
        ``speed``, ``frames_per_second`` and ``size`` (pictures).
        """
        from nonsmooth.solution.exports import exporter

        return exporter(path, **options)(self)

    def to_xarray(self) -> xarray.Dataset:
        """Samples and events as one dataset with units and labels, the same as in a folder of results."""
        from nonsmooth.solution.variables import to_dataset

        return to_dataset(self)

    def __repr__(self) -> str:
        """Status, end time [s], message, numbers of samples and events, energy residual, and findings of the checks."""
        from nonsmooth.solution.checks import findings

        read = f"; {STUCK}" if self.status in (RunStatus.SUSPECT, RunStatus.FAILED) else ""
        return (
            f"Solution({self.status} at t = {self.t_end:.9g} s: {self.message}; {len(self.t)} samples, "
            f"{len(self.events)} events, energy residual {self.energy.residual:.1e}{findings(self)}{read})"
        )

    def _repr_html_(self) -> str:
        """The page of :meth:`to_html` in a frame, for notebooks."""
        from nonsmooth.solution.pages import framed

        return framed(self)
