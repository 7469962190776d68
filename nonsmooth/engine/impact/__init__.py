"""Impacts as processes in impulses, and impacts by maps."""
