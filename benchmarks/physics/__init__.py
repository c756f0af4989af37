"""Is the task's physics step of 0.02 s fine enough? Tried against finer steps of equal contacts."""
