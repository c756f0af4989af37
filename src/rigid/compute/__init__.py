"""Work on disk: run directories, checkpoints, and the unit of work that executors run."""
