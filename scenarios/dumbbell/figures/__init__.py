"""The figures of the dumbbell scenario."""
