"""The paper's scenario: a dumbbell on a vibrating plate."""
