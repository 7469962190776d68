"""The command line: ``main`` hands a request to one of the commands."""
