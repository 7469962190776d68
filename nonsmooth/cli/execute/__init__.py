"""Execution of commands: compute, judge and save runs, and stop them at Ctrl-C."""
