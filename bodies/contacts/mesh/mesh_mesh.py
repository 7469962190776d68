"""Number of pairs of features above which a search finds near ones."""

MOST_EACH = 500
"""Largest number of pairs of features for which each pair is a contact; for more, only near pairs are contacts."""


def are_many(contacts: int) -> bool:
    """Return whether there are too many pairs of features for a contact each; a search then finds near pairs."""
    return contacts > MOST_EACH
