"""Solids in the world: whether they overlap, how far apart they are, where one meets another."""
