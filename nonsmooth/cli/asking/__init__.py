"""What the words of a request mean: components, parameters, places to write to."""
