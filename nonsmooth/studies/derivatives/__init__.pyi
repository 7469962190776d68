from nonsmooth.studies.derivatives import pictures as pictures
from nonsmooth.studies.derivatives.family import EXACT as EXACT
from nonsmooth.studies.derivatives.family import Family as Family
from nonsmooth.studies.derivatives.forward import NotDifferentiable as NotDifferentiable
from nonsmooth.studies.derivatives.forward import Sensitivity as Sensitivity
from nonsmooth.studies.derivatives.forward import sensitivity as sensitivity
from nonsmooth.studies.derivatives.least_squares import Fit as Fit
from nonsmooth.studies.derivatives.least_squares import fit as fit
