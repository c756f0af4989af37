"""`rigid compare`: robots, or ways of making them, against each other."""
