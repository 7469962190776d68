"""Engines: what integrates a laid-out system, each with its options."""
