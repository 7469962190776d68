"""The spinning egg that stands up."""

from scenarios.egg_on_table.scenario import EggOnTable

__all__ = ["EggOnTable"]
