"""Histories: states, poses, forces and energies of a run at any of its times."""
