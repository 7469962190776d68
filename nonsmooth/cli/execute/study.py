"""The course of a study: run everything that is not stored yet, and report the results."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from nonsmooth.cli.report.messages import say, tell
from nonsmooth.studies.executors import Executor
from nonsmooth.studies.status import summary
from nonsmooth.studies.study import Study
from nonsmooth.studies.study_folder import StudyFolder

if TYPE_CHECKING:
    import xarray


def perform(
    study: Study, words: Mapping[str, Any], path: Path, executor: Executor, chunk: int | None = None
) -> xarray.Dataset:
    """Run or continue a study; store the words of its request with it, and return its records."""
    try:
        with contextlib.redirect_stdout(sys.stderr):  # output of a plug-in
            found = study.run(path, executor=executor, chunk=chunk, request=words)
    except KeyboardInterrupt:
        tell(f"complete chunks stay: `nonsmooth study resume {path}` continues")
        raise
    say(summary(found))
    if texts := StudyFolder(path).texts():
        first = min(texts)
        tell(f"{len(texts)} runs have no records; the first is run {first}: {texts[first]}")
    tell(f"the study is in {path}")
    return found
