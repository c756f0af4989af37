"""Itch scratching: a robot arm scratches the itch that only the seated person knows of."""
