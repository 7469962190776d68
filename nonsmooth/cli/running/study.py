"""What all commands that run a study have in common: run what is not stored yet, tell what came of it."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nonsmooth.cli.telling.messages import say, tell
from nonsmooth.studies.executors.executor import Executor
from nonsmooth.studies.study import Study
from nonsmooth.studies.study_folder import StudyFolder
from nonsmooth.studies.summary import summary

if TYPE_CHECKING:
    import xarray


def perform(
    study: Study, words: Mapping[str, Any], path: Path, executor: Executor, chunk: int | None = None
) -> xarray.Dataset:
    """Run, or go on with, a study that was asked for in words; return all of it."""
    try:
        with contextlib.redirect_stdout(sys.stderr):  # whatever a plug-in prints
            found = study.run(path, executor=executor, chunk=chunk, request=words)
    except KeyboardInterrupt:
        tell(f"what is done stays: `nonsmooth study resume {path}` goes on")
        raise
    say(summary(found))
    if texts := StudyFolder(path).texts():
        first = min(texts)
        tell(f"{len(texts)} runs have no records; the first is run {first}: {texts[first]}")
    tell(f"the study is in {path}")
    return found
