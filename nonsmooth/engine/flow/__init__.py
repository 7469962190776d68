"""Motion between events: right-hand side, guards, bounds of what can fall, and the search for the first event."""
