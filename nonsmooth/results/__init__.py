"""Results on disk while a run goes on: what the folder holds, how it grows, how it is opened again."""
