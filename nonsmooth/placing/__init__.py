"""Named starts: a body is moved along a line until it touches another one."""
