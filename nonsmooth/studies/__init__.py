"""Studies: many runs over parameters, stored as they come, the same on one machine and on many."""

from nonsmooth.studies.drawing import draw_study
from nonsmooth.studies.executors import Dask, Executor, Serial, Threads
from nonsmooth.studies.opening import open_study
from nonsmooth.studies.records import Trajectory
from nonsmooth.studies.sampling import Sampling, columns, grid, latin_hypercube, listed, random, sobol
from nonsmooth.studies.stability import basin_stability
from nonsmooth.studies.study import Study

__all__ = [
    "Dask",
    "Executor",
    "Sampling",
    "Serial",
    "Study",
    "Threads",
    "Trajectory",
    "basin_stability",
    "columns",
    "draw_study",
    "grid",
    "latin_hypercube",
    "listed",
    "open_study",
    "random",
    "sobol",
]
