"""A top that turns over."""
