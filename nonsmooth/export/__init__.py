"""Runs as files for other programs: GLB, VTK, moving pictures, tables.

Each format is a class with its options, which writes the files of a run; ``Solution.export`` chooses it.
"""
