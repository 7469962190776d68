"""The two ways to run the engine, compiled and as plain Python, and the files of compiled code."""
