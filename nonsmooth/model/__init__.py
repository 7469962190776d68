"""Layout of a system in the memory of the engine, and checks of its start."""
