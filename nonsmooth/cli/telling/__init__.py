"""What the user reads: lines, tables, reports."""
