"""OutputSink: what a run leaves behind while it goes on."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import final

from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.solution.solution import Solution

_STEPS_AT_ONCE = 2000


class OutputSink(ABC):
    """Looks at a run wherever it could go on in another process.

    The contract:

    1. ``begin`` takes a checkpoint of the memory as the run begins.
    2. ``steps`` says how many steps the engine takes before the next look.
    3. ``keep`` takes a checkpoint of the memory, which the memory has at that moment; it may drain the records.
    4. ``finish`` gets the solution of the whole run.
    5. ``close`` comes last, also where the run or its keeping failed.
    """

    @abstractmethod
    def begin(self, checkpoint: Checkpoint) -> None:
        """Keep where the run begins.

        Raises
        ------
        FileError
            If that is not possible.
        """

    @property
    @abstractmethod
    def steps(self) -> int:
        """Steps of the engine before the next look."""

    @abstractmethod
    def keep(self, checkpoint: Checkpoint) -> None:
        """Keep what the run has done so far.

        Raises
        ------
        FileError
            If that is not possible.
        """

    @abstractmethod
    def finish(self, solution: Solution) -> None:
        """Keep how the run ended.

        Raises
        ------
        FileError
            If that is not possible.
        """

    @abstractmethod
    def close(self) -> None:
        """Leave nothing behind that works on."""


@final
class NoOutput(OutputSink):
    """A run whose results stay in memory."""

    def begin(self, checkpoint: Checkpoint) -> None:
        """Do nothing."""

    @property
    def steps(self) -> int:
        """Many: what is done between two looks costs least."""
        return _STEPS_AT_ONCE

    def keep(self, checkpoint: Checkpoint) -> None:
        """Do nothing."""

    def finish(self, solution: Solution) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Do nothing."""
