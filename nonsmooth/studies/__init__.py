"""Studies: many runs over parameters, stored as they come, the same on one machine and on many."""

from nonsmooth.studies.attractors import (
    Along,
    basin_fractions,
    basin_stability,
    features,
    recurrences,
    uncertainty_exponent,
)
from nonsmooth.studies.drawing import draw_study
from nonsmooth.studies.executors import Dask, Executor, Serial, Threads
from nonsmooth.studies.opening import open_study
from nonsmooth.studies.records import Stroboscope, Trajectory
from nonsmooth.studies.sampling import Sampling, columns, grid, latin_hypercube, listed, random, sobol
from nonsmooth.studies.study import Study

__all__ = [
    "Along",
    "Dask",
    "Executor",
    "Sampling",
    "Serial",
    "Stroboscope",
    "Study",
    "Threads",
    "Trajectory",
    "basin_fractions",
    "basin_stability",
    "columns",
    "draw_study",
    "features",
    "grid",
    "latin_hypercube",
    "listed",
    "open_study",
    "random",
    "recurrences",
    "sobol",
    "uncertainty_exponent",
]
