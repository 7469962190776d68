"""Conformance checks of scenarios: build, run, energy, results and acceptance."""

from __future__ import annotations

import copy
import dataclasses
import importlib.util
import json
import math
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.parameters import rules
from nonsmooth.results.output import Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.runs.simulate import simulate
from nonsmooth.solution.csv_tables import save_events
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System
from nonsmooth.testing.child import about_to
from nonsmooth.testing.claims import Claims, rows
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.functions import place_of_function
from nonsmooth.testing.outcome import Broken, NotChecked, Row
from nonsmooth.testing.property import Property, properties

_RESIDUAL = 1e-6
_SAMPLES = 20
_SCENARIO = Claims()


def check_scenario(scenario: Scenario, *, t_end: float | None = None) -> list[Property]:
    """Return the properties of a scenario.

    Parameters
    ----------
    scenario : Scenario
        The scenario, with parameters.
    t_end : float, optional
        End of the short runs [s]; by default after twenty sample intervals, but not after the scenario's own end.
    """
    return properties(scenario, _rows, t_end=t_end)


def _rows(scenario: Scenario, t_end: float | None) -> list[Row]:
    trial = _Trial(scenario, t_end)
    return [*component_rows(scenario), *rows(_SCENARIO, lambda: [trial], 1)]


@final
@dataclass(frozen=True, eq=False)
class _Trial:
    """A scenario and its runs to the time :attr:`end`. A run is computed once, and several properties use it."""

    scenario: Scenario
    given_end: float | None

    @cached_property
    def end(self) -> float:
        """End time of the short runs that the checks make [s]."""
        return self.given_end or min(self.scenario.t_end, _SAMPLES * self.scenario.sample_interval)

    def run(self, t_end: float, sample_interval: float, folder: Path | None = None) -> Solution:
        """Run a new system of the scenario from t = 0 to ``t_end`` [s].

        The run may take any time: the watchdog ends it only if the run reports no progress for a long time.
        """

        def is_alive(reached: float, end: float) -> None:
            about_to("the run {takes} to get on", self.scenario)

        system = self.scenario.build()
        return simulate(system, t_end, sample_interval=sample_interval, output=folder, progress=is_alive)

    def short_run(self, folder: Path | None = None) -> Solution:
        """Run a new system of the scenario from t = 0 to the time :attr:`end`."""
        return self.run(self.end, min(self.scenario.sample_interval, self.end), folder)

    @cached_property
    def again(self) -> tuple[Solution, Exception | None]:
        """A repetition of the run :attr:`found`, and the error of saving the coordinates of its bodies and its events.

        The error is None if saving succeeds.
        """
        with tempfile.TemporaryDirectory() as name:
            folder, trouble = Path(name), None
            again = self.short_run(folder)
            try:
                coordinates = self.scenario.coordinates(again)
                SolutionFolder.opened(Output(folder)).add_coordinates(coordinates, self.scenario.unit_of)
                save_events(again, folder / "events.csv")
            except Exception as error:
                trouble = error
        return again, trouble

    @cached_property
    def found(self) -> Solution | Exception:
        """The first run to the time :attr:`end`, or the error that it raised."""
        try:
            return self.short_run()
        except Exception as error:
            return error

    @property
    def solution(self) -> Solution:
        """The first short run. Raises NotChecked if the run failed."""
        if isinstance(self.found, Exception):
            raise NotChecked(f"not checked, as it does not run: {self.found}") from self.found
        return self.found

    def summary(self) -> str:
        """Return the summary as JSON text. Raise Broken if it is empty or ``units`` or ``words`` do not match it."""
        found = self.scenario.summarise(self.solution)
        if not isinstance(found, Mapping) or not found or not all(isinstance(name, str) for name in found):
            raise Broken("it must be a mapping with names, at least one", "summarise", found)
        if unknown := sorted(set(self.scenario.units) - {*found, *Scenario.units}):
            raise Broken("it must name numbers of `summarise`", "units", unknown)
        for name, words in self.scenario.words.items():
            if found.get(name) not in words:
                raise Broken("it must list all words of `summarise`", f"words of {name}", found.get(name))
        return json.dumps(dict(found), default=lambda value: np.asarray(value).tolist(), sort_keys=True)


@_SCENARIO.claim()
def _times(trial: _Trial) -> None:
    """End time and sample interval are positive and finite."""
    for name in ("t_end", "sample_interval"):
        value = float(getattr(trial.scenario, name))
        if not (math.isfinite(value) and value > 0.0):
            raise Broken("it must be positive and finite [s]", name, value)


@_SCENARIO.claim()
def _resolved(trial: _Trial) -> None:
    """`resolved` gives every parameter the value that the run uses."""
    found = trial.scenario.resolved()
    for name, (_, rule) in rules(type(trial.scenario)).items():
        if name not in found:
            raise Broken("`resolved` leaves it out", name, None)
        given = getattr(trial.scenario, name)
        if given is not None and found[name] != given:
            raise Broken(f"`resolved` gives it the value {found[name]!r}", name, given)
        if rule.unit != "" and found[name] is not None and not math.isfinite(found[name]):
            raise Broken("`resolved` gives it no finite number", name, found[name])


@_SCENARIO.claim()
def _builds_twice(trial: _Trial) -> None:
    """`build` returns a new system each time, with equal parts and starts."""
    one, other = trial.scenario.build(), trial.scenario.build()
    build = place_of_function(type(trial.scenario).build)
    if not isinstance(one, System):
        raise Broken(f"`build` returns no System: {build}", "build()", one)
    if one is other or any(a is b for a, b in zip(one.bodies, other.bodies, strict=False)):
        raise Broken("`build` returns objects of the build before")
    for name, a, b in zip(_PARTS, _parts(one), _parts(other), strict=True):
        if a != b:
            raise Broken(f"two builds differ: {build}", name, f"{a} and {b}")


@_SCENARIO.claim()
def _runs(trial: _Trial) -> None:
    """The scenario runs for a short time."""
    if isinstance(trial.found, Exception):
        raise Broken(f"until {trial.end:g} s: {trial.found}") from trial.found
    if trial.found.status != "done" or not np.all(np.isfinite(trial.found.q_end)):
        raise Broken(f"it ends with {trial.found.status}: {trial.found.message}")


@_SCENARIO.claim()
def _energy(trial: _Trial) -> None:
    """At most 1e-6 of the energy of a short run is unaccounted for."""
    residual = trial.solution.energy.residual
    if not residual <= _RESIDUAL:
        raise Broken(f"{residual:g} of the energy is not explained", "residual", residual)


@_SCENARIO.claim()
def _repeatable(trial: _Trial) -> None:
    """A second run of the scenario has the same results to the last bit."""
    again, _ = trial.again
    for name in ("t", "q", "u", "q_end", "u_end"):
        one, other = getattr(trial.solution, name), getattr(again, name)
        if not np.array_equal(one, other, equal_nan=True):
            raise Broken("two runs differ", name, _first_difference(one, other))


@_SCENARIO.claim()
def _summary(trial: _Trial) -> None:
    """`summarise` returns the same numbers and words each time, and `units` gives their units."""
    one, other = trial.summary(), trial.summary()
    if one != other:
        raise Broken("a second call gives another one", "summarise", other)


@_SCENARIO.claim()
def _coordinates(trial: _Trial) -> None:
    """`coordinates` returns an array over the samples for each name."""
    found = trial.scenario.coordinates(trial.solution)
    if without := [name for name in found if not trial.scenario.unit_of(name)]:
        raise Broken("it must have the units of all coordinates", "coordinate_units", without)
    n = len(trial.solution.t)
    for name, values in found.items():
        if np.shape(values) != (n,):
            raise Broken(f"it must have one value for each of {n} samples", name, np.shape(values))


@_SCENARIO.claim()
def _final_state(trial: _Trial) -> None:
    """`final` returns finite lists q and u."""
    found = dict(trial.scenario.final(trial.solution))
    for name in ("q", "u"):
        values = found.get(name)
        if not isinstance(values, list) or not values or not np.all(np.isfinite(values)):
            raise Broken("it must be a list of finite numbers", name, values)


@_SCENARIO.claim()
def _acceptance(trial: _Trial) -> None:
    """A run to the end time is not "suspect" (no check of the run fails) and fulfils the acceptance criteria."""
    scenario, _ = trial.scenario, trial.solution
    solution = trial.run(scenario.t_end, scenario.sample_interval)
    if solution.status == "suspect":
        raise Broken(f"it must not be suspect: {solution.message}", "status", solution.status)
    criteria = scenario.acceptance(solution)
    if not isinstance(criteria, tuple) or not all(isinstance(one, Criterion) for one in criteria):
        raise Broken("it must be a tuple of Criterion", "acceptance", criteria)
    if not criteria and not _is_default(scenario):
        raise NotChecked("there is no criterion for these parameters")
    if not criteria:
        raise Broken("there is no criterion for the default parameters", "acceptance", criteria)
    for one in criteria:
        if not one.fulfilled:
            reason = f"it must lie between {one.lower:.9g} and {one.upper:.9g}: {one.source}"
            raise Broken(reason, one.name, one.value)


@_SCENARIO.claim()
def _figures(trial: _Trial) -> None:
    """`figures` returns figures by file name, and they can be drawn."""
    if importlib.util.find_spec("matplotlib") is None:
        raise NotChecked("not checked, as matplotlib is not installed")
    from matplotlib.figure import Figure

    with _without_display():
        found = trial.scenario.figures(trial.solution)
        if not found:
            raise Broken("there are none", "figures", {})
        for name, figure in found.items():
            if not isinstance(name, str) or not isinstance(figure, Figure) or not figure.axes:
                raise Broken("it must be a matplotlib figure with axes", str(name), figure)


@_SCENARIO.claim()
def _results_can_be_saved(trial: _Trial) -> None:
    """Solution and coordinates can be written to files."""
    _, trouble = trial.again
    if trouble is not None:
        raise Broken(f"saving it fails: {trouble}") from trouble


@_SCENARIO.claim()
def _only_reads(trial: _Trial) -> None:
    """Computing the summary, the coordinates and the criteria does not change the solution."""
    solution, scenario = trial.solution, trial.scenario
    before = copy.deepcopy((solution.t, solution.q, solution.u))
    for method in (scenario.summarise, scenario.coordinates, scenario.final, scenario.acceptance):
        method(solution)
    for name, then, now in zip("tqu", before, (solution.t, solution.q, solution.u), strict=True):
        if not np.array_equal(then, now, equal_nan=True):
            raise Broken("the solution is changed", name, "")


def _first_difference(one: NDArray[np.float64], other: NDArray[np.float64]) -> str:
    if one.shape != other.shape:
        return f"{len(one)} and {len(other)} times"
    place = np.unravel_index(np.argmax(one != other), one.shape)
    return f"{one[place]:.17g} and {other[place]:.17g}, at {[int(i) for i in place]}"


def _is_default(scenario: Scenario) -> bool:
    """True if all parameters that have a default have their default value."""
    given = {name: (getattr(scenario, name), field.default) for name, (field, _) in rules(type(scenario)).items()}
    return all(value == default for value, default in given.values() if default is not dataclasses.MISSING)


_PARTS = ("bodies", "starts", "contacts", "joints", "loads", "guards", "gravity")


def _parts(system: System) -> tuple[Any, ...]:
    """Return the parts of a system in the order of :data:`_PARTS`, in a form that can be compared."""
    number = {id(body): i for i, body in enumerate(system.bodies)}
    contacts = [
        (number[id(c.first)], number[id(c.second)], c.frames, repr((c.kinematics, c.normal, c.friction, c.impact)))
        for c in system.contacts
    ]
    joints, loads = (
        [(number[id(t.first)], number[id(t.second)], t.frames, repr(t.component)) for t in ties]
        for ties in (system.joints, system.loads)
    )
    starts = [[x.tolist() for x in system.start(body)] for body in system.bodies]
    guards = [repr(guard) for guard in system.guards]
    return [repr(body) for body in system.bodies], starts, contacts, joints, loads, guards, system.gravity


@contextmanager
def _without_display() -> Iterator[None]:
    import matplotlib

    backend = matplotlib.get_backend()
    matplotlib.use("Agg")
    try:
        yield
    finally:
        matplotlib.use(backend)
