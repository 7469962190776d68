"""Execute: compute, judge and save runs, and stop at Ctrl-C."""
