"""A block that rocks on its corners: planar (scenario.py, with Housner's closed forms) and in space (spatial.py)."""

from .scenario import RockingBlock
from .spatial import RockingBlock3D

__all__ = ["RockingBlock", "RockingBlock3D"]
