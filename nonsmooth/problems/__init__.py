"""Contact and impact problems by themselves: solved from matrices and rates, without a run."""
