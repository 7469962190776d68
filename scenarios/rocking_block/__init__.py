"""A block that rocks on its corners: planar and spatial."""
