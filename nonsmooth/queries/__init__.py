"""Questions about a system that no run asks: how far bodies are apart, and which are near each other."""
