"""Many runs of a system, and what they have in common."""
