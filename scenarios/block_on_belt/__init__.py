"""A block on a moving belt, held by a spring: stick-slip."""
