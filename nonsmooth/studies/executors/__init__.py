"""Executors of studies: this thread, several threads, or workers of dask."""

from nonsmooth.studies.executors.dask import Dask
from nonsmooth.studies.executors.executor import Executor, Serial, Threads

__all__ = ["Dask", "Executor", "Serial", "Threads"]
