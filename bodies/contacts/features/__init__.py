"""What contacts of all bodies share: frames, tangents, curvature, nearest points, vertices and corners."""
