"""Other programs at work for RIGID: `exec:COMMAND` as a policy or as a task."""
