"""Prescribed motions."""
