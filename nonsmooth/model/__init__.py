"""Layout of a system in memory, and its assembly."""
