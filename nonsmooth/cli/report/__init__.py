"""Report: messages, tables and the report of a run."""
