"""SimpleScenario: a scenario that says how its system is built; the rest follows from the solution."""

from __future__ import annotations

from abc import ABC
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from nonsmooth.interfaces import Scenario
from nonsmooth.parameters import rules
from nonsmooth.runs.simulate import simulate
from nonsmooth.solution.solution import Solution
from nonsmooth.system.lookup import labels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SAMPLES = 1000


class SimpleScenario(Scenario, ABC):
    """A scenario whose coordinates are those of its bodies; a final subclass gives title, t_end, build, acceptance.

    Its figure shows all coordinates over time, its summary the number of impacts and the energy account.  A scenario
    with coordinates, numbers or figures of its own is a :class:`nonsmooth.interfaces.Scenario`.
    """

    units: ClassVar[Mapping[str, str]] = {"restitution_loss": "J", "friction_loss": "J"}

    @property
    def sample_interval(self) -> float:
        """A thousandth of the run [s]."""
        return self.t_end / _SAMPLES

    def resolved(self) -> Mapping[str, Any]:
        """Return all parameters as given."""
        return {name: getattr(self, name) for name in rules(type(self))}

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """Return nothing: q and u are in the results as they are, with names and units."""
        return {}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Return all coordinates and velocities at the end."""
        return {"q": solution.q_end.tolist(), "u": solution.u_end.tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Return the number of impacts and what was lost [J]."""
        account = solution.energy
        return {
            "impacts": solution.counters.impacts,
            "restitution_loss": account.restitution_loss,
            "friction_loss": account.friction_loss,
        }

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """Return the coordinates over time."""
        return {"coordinates": self._draw(solution)}

    @classmethod
    def gallery(cls, progress: Any) -> Mapping[str, Any]:
        """Run the scenario with the defaults of its parameters; return its figure."""
        one = cls()
        solution = simulate(one.build(), one.t_end, sample_interval=one.sample_interval, progress=progress)
        return dict(one.figures(solution))

    def _draw(self, solution: Solution) -> Figure:
        from matplotlib.figure import Figure

        names = [f"{name} [{unit}]" for _, name, unit in labels(solution.system).coordinates]
        figure = Figure(figsize=(6.0, 1.0 + 1.2 * len(names)), layout="constrained")
        axes = figure.subplots(len(names), 1, sharex=True, squeeze=False)[:, 0]
        for name, values, one in zip(names, solution.q.T, axes, strict=True):
            one.plot(solution.t, values)
            one.set_ylabel(name)
        axes[0].set_title(self.title)
        axes[-1].set_xlabel("time [s]")
        return figure
