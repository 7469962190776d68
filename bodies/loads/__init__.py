"""Loads: forces and moments between two frames."""
