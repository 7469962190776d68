"""What the user writes: bodies, contacts, laws, starts."""
