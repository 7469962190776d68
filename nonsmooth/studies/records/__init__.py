"""What a study keeps of each run."""

from nonsmooth.studies.records.stroboscope import Stroboscope
from nonsmooth.studies.records.trajectory import Trajectory

__all__ = ["Stroboscope", "Trajectory"]
