"""The arrays of the memory, room by room: whose a scratch array is, and how long."""
