"""Make functions of plug-ins callable for the engine, by their addresses."""
