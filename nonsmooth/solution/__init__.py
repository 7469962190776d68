"""What a run computed."""
