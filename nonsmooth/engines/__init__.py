"""Engines that integrate an assembled system, each with its options."""
