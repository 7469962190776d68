"""Texts out of which ``nonsmooth new`` makes files."""
