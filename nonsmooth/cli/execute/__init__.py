"""Execute: compute, judge and save runs and studies, and stop at Ctrl-C."""
