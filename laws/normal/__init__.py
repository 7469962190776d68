"""Normal laws."""
