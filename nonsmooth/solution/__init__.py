"""Solutions of runs: samples, events, modes, energy, and the end."""
