"""Contacts with a plane."""
