"""A disc that strikes two balls at rest: Bernoulli's problem."""
