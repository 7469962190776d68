"""The Delassus matrix, the islands of contacts, and the order of the contacts within them."""
