"""Pairs of shapes: contact kinematics in closed form."""
