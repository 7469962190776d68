"""Results of a run on disk: content of the folder, writing during the run, and opening."""
