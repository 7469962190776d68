"""FCL, the Flexible Collision Library, behind an adapter that lets nothing unchecked reach its C++.

It is for the search of near pairs, for distances to start from and for an independent look at gaps.  It never gives the
gap of a run: its tolerances are absolute, and wrong input ends the process without an exception.
"""
