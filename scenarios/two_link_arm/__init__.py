"""A two-link arm that touches a moving belt: Painleve's paradox of a robot."""
