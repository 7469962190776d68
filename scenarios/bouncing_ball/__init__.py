"""A ball on a vibrating table."""
