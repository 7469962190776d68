"""A rod that slides on a rough plane: Painleve's paradox."""
