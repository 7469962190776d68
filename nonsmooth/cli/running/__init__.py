"""What commands that run something have in common: compute, judge, save; and how Ctrl-C ends it."""
