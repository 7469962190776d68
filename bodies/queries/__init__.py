"""Distances by libraries for collision detection, behind an adapter that lets nothing unchecked reach their C++.

They check distances independently, and answer for shapes without convex parts.  They never give the gap of a run:
their tolerances are absolute, and wrong input ends the process without an exception.
"""
