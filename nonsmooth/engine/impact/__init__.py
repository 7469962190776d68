"""Impacts: the energetic theory of multiple impacts, integrated over impulses, and impacts by maps of velocities."""
