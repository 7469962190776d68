"""Runs as files for other programs: GLB, VTK, moving pictures, tables.

Each format is a class that holds its options, and gives the files of a run; ``Solution.export`` writes them.
"""
