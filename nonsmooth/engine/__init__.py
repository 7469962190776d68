"""The engine: flow, guards, contact, impact, and the automaton that orders them."""
