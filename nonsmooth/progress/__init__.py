"""Progress of long computations on standard error: a bar on a terminal, an occasional line elsewhere."""

from nonsmooth.progress.displays import Bar, Display, Lines, Quiet, SameLine, of_long_run, on_standard_error
from nonsmooth.progress.meter import ProgressMeter, RangeCovered, RunsDone, TimeReached

__all__ = [
    "Bar",
    "Display",
    "Lines",
    "ProgressMeter",
    "Quiet",
    "RangeCovered",
    "RunsDone",
    "SameLine",
    "TimeReached",
    "of_long_run",
    "on_standard_error",
]
