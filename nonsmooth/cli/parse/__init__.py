"""Parsing of requests: options of commands, and the scenarios, components and values that their arguments denote."""
