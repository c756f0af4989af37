"""A run directory: what belongs to one measurement, whose it is, and how it goes on."""
