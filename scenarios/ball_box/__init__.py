"""Balls that fall into an open box and come to rest."""
