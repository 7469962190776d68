"""Distances by libraries for collision detection, behind an adapter that lets nothing unchecked reach their C++.

They are asked where contacts of a pair do not tell, and for an independent look at gaps.  They never give the gap of a
run: their tolerances are absolute, and wrong input ends the process without an exception.
"""
