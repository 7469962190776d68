"""Which parameters a study runs: grids, draws and lists."""

from nonsmooth.studies.sampling.drawn import latin_hypercube, random, sobol
from nonsmooth.studies.sampling.explicit import columns, grid, listed
from nonsmooth.studies.sampling.sampling import SamplePoints, Sampling

__all__ = ["SamplePoints", "Sampling", "columns", "grid", "latin_hypercube", "listed", "random", "sobol"]
