"""Euler's disk: a disc that rolls on its rim."""
