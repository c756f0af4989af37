"""Bed bathing: a robot arm wipes the arm of a person who lies on a bed."""
