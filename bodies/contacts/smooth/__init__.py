"""Smooth bodies: the search for nearest points by support functions, and what is made of it."""
