"""Where the groups of measurements run: here, in a process for each core, or on a Ray cluster."""
