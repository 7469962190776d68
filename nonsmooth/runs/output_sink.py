"""OutputSink: the destination of a run's results while the run is under way."""

from __future__ import annotations

from nonsmooth.model.checkpoint import Checkpoint
from nonsmooth.solution.solution import Solution

_STEPS_PER_CALL = 2000
"""Steps of the engine per call if nothing is written. So many cost far more than the call itself."""


class OutputSink:
    """Takes the results of a run at its checkpoints, from which another process could continue it.

    This class writes nothing, for a run whose results stay in memory. The order of calls:

    1. ``begin`` with the checkpoint at the start of the run.
    2. ``write`` with each checkpoint, which the memory holds at that moment. It may drain the records.
    3. ``finish`` with the solution of the whole run.
    4. ``close`` at the end, also if the run or a call failed.
    """

    def steps(self) -> int:
        """Largest number of steps of the engine until the next call of ``write``."""
        return _STEPS_PER_CALL

    def begin(self, checkpoint: Checkpoint) -> None:
        """Write the start of the run.

        Raises
        ------
        FileError
            If it cannot be written.
        """

    def write(self, checkpoint: Checkpoint) -> None:
        """Write the results up to a checkpoint, if it is time.

        Raises
        ------
        FileError
            If they cannot be written.
        """

    def finish(self, solution: Solution) -> None:
        """Write the remaining results and the end of the run.

        Raises
        ------
        FileError
            If they cannot be written.
        """

    def close(self) -> None:
        """Release files and threads."""
