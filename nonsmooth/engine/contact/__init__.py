"""Forces of closed contacts: the complementarity problem, its solvers, and forces that are not unique."""
