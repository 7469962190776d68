"""The arrays of the memory, layer by layer: whose a scratch array is, and how long."""
