"""Motion of bodies, articulations and contacts, and the search for those that come near."""
