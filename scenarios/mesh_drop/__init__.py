"""A part, given as a mesh, is dropped on flat ground."""
