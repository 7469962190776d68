"""The spinning egg that stands up."""
