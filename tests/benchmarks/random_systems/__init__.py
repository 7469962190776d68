"""Random systems: run by the thousand, looked at by checks that share nothing with the engine."""
