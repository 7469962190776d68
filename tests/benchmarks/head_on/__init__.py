"""Pairs of bodies that meet head on, in line with their axes: does each collide as the closed form says?"""
