"""Three balls, rigidly joined, on a vibrating plate."""
