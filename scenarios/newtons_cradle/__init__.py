"""Newton's cradle: a row of balls that touch, struck at one end."""
