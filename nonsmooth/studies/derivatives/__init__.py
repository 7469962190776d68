"""How motions change with parameters and starts, and parameters fitted to measurements."""

from nonsmooth.studies.derivatives.family import EXACT, Family
from nonsmooth.studies.derivatives.forward import NotDifferentiable, Sensitivity, sensitivity
from nonsmooth.studies.derivatives.least_squares import Fit, fit

__all__ = ["EXACT", "Family", "Fit", "NotDifferentiable", "Sensitivity", "fit", "sensitivity"]
