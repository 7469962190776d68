"""The rattleback: an ellipsoid with skewed inertia that turns its spin round."""
