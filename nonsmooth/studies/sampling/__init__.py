"""Which parameters a study runs: grids, draws and lists."""

from nonsmooth.studies.sampling.drawn import latin_hypercube, random, sobol
from nonsmooth.studies.sampling.grid import grid
from nonsmooth.studies.sampling.listed import columns, listed
from nonsmooth.studies.sampling.points import Points
from nonsmooth.studies.sampling.sampling import Sampling

__all__ = ["Points", "Sampling", "columns", "grid", "latin_hypercube", "listed", "random", "sobol"]
