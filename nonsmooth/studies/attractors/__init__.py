"""Attractors of a study, their basins, and the change of these along a parameter."""

from nonsmooth.studies.attractors.boundary import Boundary, uncertainty_exponent
from nonsmooth.studies.attractors.features import features
from nonsmooth.studies.attractors.matching import Along, matched
from nonsmooth.studies.attractors.recurrences import recurrences
from nonsmooth.studies.attractors.shares import basin_fractions, basin_stability

__all__ = [
    "Along",
    "Boundary",
    "basin_fractions",
    "basin_stability",
    "features",
    "matched",
    "recurrences",
    "uncertainty_exponent",
]
