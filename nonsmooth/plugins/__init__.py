"""Finding and compiling plug-ins."""
