"""Studies: many runs over parameters, attractors, periodic orbits, derivatives, and fits."""

from nonsmooth.studies.attractors import (
    Along,
    basin_fractions,
    basin_stability,
    features,
    recurrences,
    uncertainty_exponent,
)
from nonsmooth.studies.dask import Dask
from nonsmooth.studies.derivatives import Family, fit, sensitivity
from nonsmooth.studies.drawing import draw_study
from nonsmooth.studies.executors import Executor, Serial, Threads
from nonsmooth.studies.orbits import bifurcation, continuation, hysteresis, lyapunov, orbit
from nonsmooth.studies.sampling import Sampling, columns, grid, latin_hypercube, listed, random, sobol
from nonsmooth.studies.state_records import Stroboscope, Trajectory
from nonsmooth.studies.status import CaseStatus
from nonsmooth.studies.study import Study
from nonsmooth.studies.study_folder import open_study

__all__ = [
    "Along",
    "CaseStatus",
    "Dask",
    "Executor",
    "Family",
    "Sampling",
    "Serial",
    "Stroboscope",
    "Study",
    "Threads",
    "Trajectory",
    "basin_fractions",
    "basin_stability",
    "bifurcation",
    "columns",
    "continuation",
    "draw_study",
    "features",
    "fit",
    "grid",
    "hysteresis",
    "latin_hypercube",
    "listed",
    "lyapunov",
    "open_study",
    "orbit",
    "random",
    "recurrences",
    "sensitivity",
    "sobol",
    "uncertainty_exponent",
]
