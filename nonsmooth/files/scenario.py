"""A scenario that is read from a scenario file; the command line runs it like an installed scenario."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, final

from nonsmooth.errors import InvalidInput
from nonsmooth.files.reading import Setup, setup_of
from nonsmooth.interfaces import Criterion, Scenario
from nonsmooth.parameters import Rule
from nonsmooth.solution.solution import Solution
from nonsmooth.system.system import System

_SAMPLES = 2000


@final
@dataclass(frozen=True)
class FileScenario(Scenario):
    """Scenario whose system is read from a file.

    It draws no figures. Its results are q and u; it defines no further coordinates, such as an angle.
    """

    title: ClassVar[str] = "A scenario file"

    setup: Setup

    @classmethod
    def of(cls, system: System, t_end: float) -> FileScenario:
        """Scenario of a system; its numbers can be varied as if the system was read from a file.

        Raises
        ------
        InvalidInput
            A component cannot be written to a file; the message names it.
        """
        return cls(setup_of(system, t_end))

    def _check(self) -> None:
        if self.setup.t_end is None:
            raise InvalidInput(
                f"{self.setup.path}: t_end", "must be given to run", None, "Add t_end = 1.0 [s], or --set t_end=1."
            )

    @property
    def t_end(self) -> float:
        """End time of the file [s]; 0 if the file has none."""
        return float(self.setup.t_end or 0.0)

    @property
    def sample_interval(self) -> float:
        """Time between samples of the file [s], by default a two-thousandth of the end time."""
        return self.setup.sample_interval or self.t_end / _SAMPLES

    def build(self) -> System:
        """System of the file, built anew."""
        return self.setup.build()

    def resolved(self) -> Mapping[str, Any]:
        """Title, end time and sample interval of the run [s], and the values that the command line has set."""
        said = {"title": self.setup.title, "t_end": self.t_end, "sample_interval": self.sample_interval}
        return {**self.setup.changes, **said}

    @property
    def name(self) -> str:
        """Path of the file."""
        return str(self.setup.path)

    @property
    def varies(self) -> Mapping[str, Rule]:
        """Rule (unit and allowed range) of each number of the file, by dotted key ("bodies.ball.radius")."""
        return {key: rule for key, (_, rule) in self.setup.numbers.items()}

    @property
    def values(self) -> Mapping[str, Any]:
        """Value of each number of the file, by dotted key ("bodies.ball.radius")."""
        return {key: number for key, (number, _) in self.setup.numbers.items()}

    def varied(self, **changes: Any) -> FileScenario:
        """Scenario of the same file with some numbers changed, by dotted key."""
        return FileScenario(self.setup.varied(changes))

    def coordinates(self, solution: Solution) -> Mapping[str, Any]:
        """No coordinates of its own: an empty mapping."""
        return {}

    def final(self, solution: Solution) -> Mapping[str, list[float]]:
        """Coordinates q and velocities u of all bodies at the end, in the order of the file."""
        return {"q": solution.q_end.tolist(), "u": solution.u_end.tolist()}

    def summarise(self, solution: Solution) -> Mapping[str, Any]:
        """Losses of energy by their cause [J]."""
        energy = solution.energy
        return {"restitution_loss": energy.restitution_loss, "friction_loss": energy.friction_loss}

    def acceptance(self, solution: Solution) -> tuple[Criterion, ...]:
        """No expected results: a file declares a system only."""
        return ()

    def figures(self, solution: Solution) -> Mapping[str, Any]:
        """No figures: an empty mapping."""
        return {}

    @classmethod
    def gallery(cls, progress: Any) -> Mapping[str, Any]:
        """No published figures: an empty mapping, without use of ``progress``."""
        return {}
