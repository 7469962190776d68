"""What is seen of a system, and where it is at times of a run: for viewer, exports and pictures."""
