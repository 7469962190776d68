"""One run after another, in this thread."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass
from typing import final

from nonsmooth.studies.executors.executor import Executor
from nonsmooth.studies.work import Block, Chunk, Work


@final
@dataclass(frozen=True)
class Serial(Executor):
    """Does everything here."""

    def blocks(self, work: Work, chunks: Sequence[Chunk]) -> Generator[Block, None, None]:
        """Yield one after another."""
        for chunk in chunks:
            yield work.block(chunk)
