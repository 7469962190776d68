"""A slider-crank mechanism whose slider has clearance in its guide."""
