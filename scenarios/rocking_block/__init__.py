"""A block that rocks on its corners: planar (scenario.py, with Housner's closed forms) and in space (spatial.py)."""

from scenarios.rocking_block.scenario import RockingBlock
from scenarios.rocking_block.spatial import RockingBlock3D

__all__ = ["RockingBlock", "RockingBlock3D"]
