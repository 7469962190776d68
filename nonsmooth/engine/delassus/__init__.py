"""Delassus matrices, the islands they fall into, and the order of their rows."""
