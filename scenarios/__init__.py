"""Ready-made systems with their figures and acceptance numbers."""
