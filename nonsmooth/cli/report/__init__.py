"""Output of commands: messages, tables and the report of a run."""
