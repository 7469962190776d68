"""Scene: visible parts of a system and their places at times of a run, for viewer, exports and pictures."""
