"""The recipes that make humans and robots, each resumable and made from a recorded seed."""
