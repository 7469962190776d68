"""What the engine remembers: one table of scalars and two heaps, their layout, and the codes that stand in them."""
