"""Numerical methods that know no mechanics: linear systems, band matrices, roots and Runge-Kutta steps."""
