"""Motion of bodies, linkages and contacts, and the search for those that come near."""
