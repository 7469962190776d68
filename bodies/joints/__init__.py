"""Joints: bilateral constraints between two frames."""
