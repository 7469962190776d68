"""Parse: options of commands, and the scenarios, components, values and places that their words mean."""
