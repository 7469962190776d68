"""Named starts: a body is moved along a line until it meets what it would touch."""
