"""Contact and impact problems, solved from matrices and rates, without a run."""
