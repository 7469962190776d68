"""Linear algebra, band matrices and Runge-Kutta steps."""
