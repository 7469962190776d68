"""Properties of scenarios."""

from __future__ import annotations

import copy
import dataclasses
import importlib.util
import json
import math
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.parameters import rules
from nonsmooth.results.output import Output
from nonsmooth.results.solution_folder import SolutionFolder
from nonsmooth.simulate import simulate
from nonsmooth.solution.csv_tables import save_events
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System
from nonsmooth.testing.budget import where
from nonsmooth.testing.component import component_rows
from nonsmooth.testing.property import Broken, NotChecked, Property, properties

_RESIDUAL = 1e-6
_SAMPLES = 20


def check_scenario(scenario: Scenario, *, t_end: float | None = None) -> list[Property]:
    """Return the properties of a scenario.

    Parameters
    ----------
    scenario : Scenario
        The scenario, with parameters.
    t_end : float, optional
        How long to run it [s]; by default twenty samples, or to its end if that comes sooner.
    """
    look = _Look(scenario, t_end)
    rows: list[tuple[str, str, Callable[[], None]]] = [
        ("times", "end time and sample interval are positive and finite", look.times),
        ("resolved", "`resolved` gives every parameter the value that the run uses", look.resolved),
        ("builds twice", "`build` returns a new system each time, with equal parts and starts", look.twice),
        ("runs", "it runs for a short time", look.runs),
        ("energy", "the energy account of the run closes", look.energy),
        ("repeatable", "a second run is the same to the last bit", look.repeatable),
        ("summary", "`summarise` returns numbers and words by name, the same each time, `units` theirs", look.summary),
        ("coordinates", "`coordinates` returns an array over the samples for each name", look.coordinates),
        ("final state", "`final` returns finite lists q and u", look.final),
        (
            "acceptance",
            "a full run is not suspect; it has criteria, each with a finite number, and fulfils all",
            look.acceptance,
        ),
        ("figures", "`figures` returns figures by file name, and they can be drawn", look.figures),
        ("results can be saved", "solution and coordinates can be written to files", look.files),
        ("only reads", "summary, coordinates and criteria leave the solution as it is", look.only_reads),
    ]
    return properties(scenario, [*component_rows(scenario), *rows])


class _Look:
    def __init__(self, scenario: Scenario, t_end: float | None) -> None:
        self._scenario = scenario
        self._given = t_end

    @cached_property
    def _end(self) -> float:
        return self._given or min(self._scenario.t_end, _SAMPLES * self._scenario.sample_interval)

    def _run(self, folder: Path | None = None) -> Solution:
        interval = min(self._scenario.sample_interval, self._end)
        return simulate(self._scenario.build(), self._end, sample_interval=interval, output=folder)

    @cached_property
    def _again(self) -> tuple[Solution, Exception | None]:
        """A second run, and what went wrong when it was saved with the coordinates."""
        with tempfile.TemporaryDirectory() as name:
            folder, trouble = Path(name), None
            again = self._run(folder)
            try:
                SolutionFolder.opened(Output(folder)).add_coordinates(
                    self._scenario.coordinates(again), self._scenario.unit_of
                )
                save_events(again, folder / "events.csv")
            except Exception as error:
                trouble = error
        return again, trouble

    @cached_property
    def _solution(self) -> Solution | Exception:
        try:
            return self._run()
        except Exception as error:
            return error

    @property
    def solution(self) -> Solution:
        """The short run."""
        if isinstance(self._solution, Exception):
            raise NotChecked(f"not checked, as it does not run: {self._solution}") from self._solution
        return self._solution

    def times(self) -> None:
        for name in ("t_end", "sample_interval"):
            value = float(getattr(self._scenario, name))
            if not (math.isfinite(value) and value > 0.0):
                raise Broken("it must be positive and finite [s]", name, value)

    def resolved(self) -> None:
        found = self._scenario.resolved()
        for name, (_, rule) in rules(type(self._scenario)).items():
            if name not in found:
                raise Broken("`resolved` leaves it out", name, None)
            given = getattr(self._scenario, name)
            if given is not None and found[name] != given:
                raise Broken(f"`resolved` gives it the value {found[name]!r}", name, given)
            if rule.unit != "" and found[name] is not None and not math.isfinite(found[name]):
                raise Broken("`resolved` gives it no finite number", name, found[name])

    def twice(self) -> None:
        one, other = self._scenario.build(), self._scenario.build()
        build = where(type(self._scenario).build)
        if not isinstance(one, System):
            raise Broken(f"`build` returns no System: {build}", "build()", one)
        if one is other or any(a is b for a, b in zip(one.bodies, other.bodies, strict=False)):
            raise Broken("`build` returns objects of the build before")
        for name, a, b in zip(_PARTS, _parts(one), _parts(other), strict=True):
            if a != b:
                raise Broken(f"two builds differ: {build}", name, f"{a} and {b}")

    def runs(self) -> None:
        if isinstance(self._solution, Exception):
            raise Broken(f"until {self._end:g} s: {self._solution}") from self._solution
        if self.solution.status != "done" or not np.all(np.isfinite(self.solution.q_end)):
            raise Broken(f"it ends with {self.solution.status}: {self.solution.message}")

    def energy(self) -> None:
        residual = self.solution.energy.residual
        if not residual <= _RESIDUAL:
            raise Broken(f"{residual:g} of the energy is not explained", "residual", residual)

    def repeatable(self) -> None:
        again, _ = self._again
        for name in ("t", "q", "u", "q_end", "u_end"):
            one, other = getattr(self.solution, name), getattr(again, name)
            if not np.array_equal(one, other, equal_nan=True):
                raise Broken("two runs differ", name, _first_difference(one, other))

    def summary(self) -> None:
        one, other = (self._summary() for _ in range(2))
        if one != other:
            raise Broken("a second call gives another one", "summarise", other)

    def _summary(self) -> str:
        found = self._scenario.summarise(self.solution)
        if not isinstance(found, Mapping) or not found or not all(isinstance(name, str) for name in found):
            raise Broken("it must be a mapping with names, at least one", "summarise", found)
        unknown = sorted(set(self._scenario.units) - {*found, *Scenario.units})
        if unknown:
            raise Broken("it must name numbers of `summarise`", "units", unknown)
        for name, words in self._scenario.words.items():
            if found.get(name) not in words:
                raise Broken("it must list all words of `summarise`", f"words of {name}", found.get(name))
        return json.dumps(dict(found), default=lambda value: np.asarray(value).tolist(), sort_keys=True)

    def coordinates(self) -> None:
        found = self._scenario.coordinates(self.solution)
        without = [name for name in found if not self._scenario.unit_of(name)]
        if without:
            raise Broken("it must have the units of all coordinates", "coordinate_units", without)
        for name, values in found.items():
            if np.shape(values) != (len(self.solution.t),):
                raise Broken(
                    f"it must have one value for each of {len(self.solution.t)} samples", name, np.shape(values)
                )

    def final(self) -> None:
        found = dict(self._scenario.final(self.solution))
        for name in ("q", "u"):
            values = found.get(name)
            if not isinstance(values, list) or not values or not np.all(np.isfinite(values)):
                raise Broken("it must be a list of finite numbers", name, values)

    def acceptance(self) -> None:
        scenario = self._scenario
        if isinstance(self._solution, Exception):
            raise NotChecked(f"not checked, as it does not run: {self._solution}") from self._solution
        solution = simulate(scenario.build(), scenario.t_end, sample_interval=scenario.sample_interval)
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
                raise Broken(
                    f"it must lie between {one.lower:.9g} and {one.upper:.9g}: {one.source}", one.name, one.value
                )

    def figures(self) -> None:
        if importlib.util.find_spec("matplotlib") is None:
            raise NotChecked("not checked, as matplotlib is not installed")
        from matplotlib.figure import Figure

        with _without_display():
            found = self._scenario.figures(self.solution)
            if not found:
                raise Broken("there are none", "figures", {})
            for name, figure in found.items():
                if not isinstance(name, str) or not isinstance(figure, Figure) or not figure.axes:
                    raise Broken("it must be a matplotlib figure with axes", str(name), figure)

    def files(self) -> None:
        _, trouble = self._again
        if trouble is not None:
            raise Broken(f"saving it fails: {trouble}") from trouble

    def only_reads(self) -> None:
        before = copy.deepcopy((self.solution.t, self.solution.q, self.solution.u))
        self._scenario.summarise(self.solution)
        self._scenario.coordinates(self.solution)
        self._scenario.final(self.solution)
        self._scenario.acceptance(self.solution)
        for name, then, now in zip("tqu", before, (self.solution.t, self.solution.q, self.solution.u), strict=True):
            if not np.array_equal(then, now, equal_nan=True):
                raise Broken("the solution is changed", name, "")


def _first_difference(one: NDArray[np.float64], other: NDArray[np.float64]) -> str:
    if one.shape != other.shape:
        return f"{len(one)} and {len(other)} times"
    place = np.unravel_index(np.argmax(one != other), one.shape)
    return f"{one[place]:.17g} and {other[place]:.17g}, at {[int(i) for i in place]}"


def _is_default(scenario: Scenario) -> bool:
    """Tell whether all parameters that have a default have that value."""
    given = {name: (getattr(scenario, name), field.default) for name, (field, _) in rules(type(scenario)).items()}
    return all(value == default for value, default in given.values() if default is not dataclasses.MISSING)


_PARTS = ("bodies", "starts", "contacts", "joints", "loads", "guards", "gravity")


def _parts(system: System) -> tuple[Any, ...]:
    """Return what a system is made of, comparable."""
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
