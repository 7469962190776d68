"""The engine of a stored run that nobody can load."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, NoReturn, final

from nonsmooth.errors import InvalidInput
from nonsmooth.interfaces.engine import Engine

if TYPE_CHECKING:
    from nonsmooth.engine.memory.memory import Memory
    from nonsmooth.system.system import System


@final
@dataclass(frozen=True)
class Unavailable(Engine):
    """Stands for the engine of a run that was stored: what it left at samples and events is known, nothing goes on.

    Attributes
    ----------
    described : dict
        Its class and its options, as the folder says them.
    recorded_contacts : bool
        Whether its events hold modes and impulses.
    """

    described: Mapping[str, Any] = field(hash=False)
    recorded_contacts: bool

    @property
    def records_contacts(self) -> bool:
        """As the engine that ran."""
        return self.recorded_contacts

    def check(self, system: System) -> None:
        """Refuse nothing: results are looked at."""

    def counts(self, n_slots: int) -> Mapping[str, int]:
        """Return nothing."""
        return {}

    def settings(self, time_scale: float) -> Mapping[str, float]:
        """Return nothing."""
        return {}

    def advance(self, call: Callable[..., Any], memory: Memory, most_steps: int, wary: bool) -> NoReturn:
        """Refuse to go on."""
        raise InvalidInput("engine", "must be there to go on", dict(self.described), "Give the one that ran.")
