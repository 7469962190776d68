"""How far something is that takes long, on standard error: a bar on a terminal, an occasional line elsewhere."""

from nonsmooth.progress.bar import Bar
from nonsmooth.progress.display import Display
from nonsmooth.progress.lines import Lines
from nonsmooth.progress.pace import Pace
from nonsmooth.progress.quiet import Quiet
from nonsmooth.progress.range_covered import RangeCovered
from nonsmooth.progress.runs_done import RunsDone
from nonsmooth.progress.standard_error import on_standard_error
from nonsmooth.progress.time_reached import TimeReached

__all__ = ["Bar", "Display", "Lines", "Pace", "Quiet", "RangeCovered", "RunsDone", "TimeReached", "on_standard_error"]
