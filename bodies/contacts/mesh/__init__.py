"""Contacts with meshes, and the search for features of theirs that come near."""
