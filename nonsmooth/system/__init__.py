"""Systems: bodies, contacts, laws and starts that the user declares."""
