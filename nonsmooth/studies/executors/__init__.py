"""Where the runs of a study are done: here, in threads, or by the workers of dask."""

from nonsmooth.studies.executors.dask import Dask
from nonsmooth.studies.executors.executor import Executor, Serial, Threads

__all__ = ["Dask", "Executor", "Serial", "Threads"]
