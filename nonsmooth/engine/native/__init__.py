"""The two ways to run engine functions, compiled and plain, and the cache of what is compiled."""
