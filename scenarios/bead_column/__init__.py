"""A column of beads that falls on a wall."""
