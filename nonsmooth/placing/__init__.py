"""Placing of a body at the start of a run: it is moved along a line until it touches another body."""
